//! Threshold masks as messages.

use strew_error::Error;
use strew_query::{
    Parameter, Value, Values, groups,
    parameters::{ALPHA, MAP, PROFILE, TABLE},
    patterns::{BITS, MASK_SEED, MASK_SIZE},
};
use strew_service::access::Caller;
use strew_service::{
    Service,
    mask::{Drawn, MaskQuery},
};

use super::proto::{GetMaskRequest, GetMaskResponse};

/// The mask that a request describes.
pub(super) async fn mask(
    service: &Service,
    caller: &Caller,
    request: GetMaskRequest,
) -> Result<GetMaskResponse, Error> {
    let bits = request.bits.map(|bits| Value::Text(bits.to_string()));
    let size = request.size.map(|size| Value::Integer(size.into()));
    let given: [(&'static Parameter, Option<Value>); 7] = [
        (&PROFILE, request.profile.map(Value::Text)),
        (&ALPHA, request.alpha.map(Value::Text)),
        (&MAP, request.map.map(Value::Text)),
        (&TABLE, request.table.map(Value::Text)),
        (&MASK_SIZE, size),
        (&MASK_SEED, request.seed.map(Value::Integer)),
        (&BITS, bits),
    ];
    let mut values = Values::new(groups::MASK, "");
    values.add_values(given);
    let query = MaskQuery::check(&values, &service.catalog())?;
    let png = service.mask(caller, query, Drawn::Thresholds).await?;
    Ok(GetMaskResponse { png: png.into() })
}
