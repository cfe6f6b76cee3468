//! Loaded tables, periods and masks as messages.

use strew_catalog::{Catalog, Entry};
use strew_error::Error;
use strew_query::{
    Periods, Value, Values, groups,
    parameters::{ALPHA, MAP, MOST, PERIODIC, PROFILE, TABLE},
    patterns::{BITS, MASK_SEED, MASK_SIZE},
};
use strew_service::access::Caller;
use strew_service::{
    Service,
    mask::{Drawn, MaskQuery},
};

use super::{
    proto::{
        self, Figure, Figures, GetMaskRequest, GetMaskResponse, ListPeriodsRequest,
        ListPeriodsResponse, Profile, Provenance,
    },
    resolved::period,
};

pub(super) fn profile(entry: &Entry, catalog: &Catalog) -> Profile {
    let number = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let of = &entry.provenance;
    let parameter = |(name, value)| proto::Parameter { name, value };
    let figure = |(name, value)| Figure { name, value };
    let figures = of.figures.iter().map(|figures| Figures {
        subject: figures.subject.clone(),
        seen: figures.seen,
        points: figures.points,
        values: figures.values.iter().cloned().map(figure).collect(),
    });
    Profile {
        profile: entry.key.profile.as_ref().into(),
        alpha: entry.key.alpha.to_string(),
        map: entry.key.size.to_string(),
        radius: entry.radius,
        intervals: number(entry.intervals),
        blocks: number(entry.blocks()),
        bytes: entry.bytes,
        joint_kinds: catalog.joint_kinds(entry),
        digest: entry.digest.clone(),
        provenance: Some(Provenance {
            optimizer: of.optimizer.clone(),
            parameters: of.parameters.iter().cloned().map(parameter).collect(),
            seed: of.seed,
            twins: of.twins.iter().map(ToString::to_string).collect(),
            figures: figures.collect(),
        }),
    }
}

pub(super) fn periods(
    request: ListPeriodsRequest,
    service: &Service,
) -> Result<ListPeriodsResponse, Error> {
    let mut values = Values::new(groups::PERIODS, "");
    values.add_values([
        (&PROFILE, request.profile.map(Value::Text)),
        (&ALPHA, request.alpha.map(Value::Text)),
        (&MAP, request.map.map(Value::Text)),
        (&PERIODIC, request.periodic.map(Value::Integer)),
        (&MOST, request.most.map(Value::Integer)),
    ]);
    let found = Periods::of(&values, &service.catalog())?;
    Ok(ListPeriodsResponse {
        alpha: found.alpha,
        map: found.map,
        radius: found.radius,
        most_points: found.most_points,
        periods: found.periods.into_iter().map(period).collect(),
    })
}

pub(super) async fn mask(
    service: &Service,
    caller: &Caller,
    request: GetMaskRequest,
) -> Result<GetMaskResponse, Error> {
    let bits = request.bits.map(|bits| Value::Text(bits.to_string()));
    let size = request.size.map(|size| Value::Integer(size.into()));
    let mut values = Values::new(groups::MASK, "");
    values.add_values([
        (&PROFILE, request.profile.map(Value::Text)),
        (&ALPHA, request.alpha.map(Value::Text)),
        (&MAP, request.map.map(Value::Text)),
        (&TABLE, request.table.map(Value::Text)),
        (&MASK_SIZE, size),
        (&MASK_SEED, request.seed.map(Value::Integer)),
        (&BITS, bits),
    ]);
    let query = MaskQuery::check(&values, &service.catalog())?;
    let png = service.mask(caller, query, Drawn::Thresholds).await?;
    Ok(GetMaskResponse { png: png.into() })
}
