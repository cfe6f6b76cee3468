//! Lists of periods as messages.

use strew_error::Error;
use strew_query::{
    Parameter, PeriodEcho, Periods, Value, Values, groups,
    parameters::{ALPHA, MAP, MOST, PERIODIC, PROFILE},
};
use strew_service::Service;

use super::proto::{self, ListPeriodsRequest, ListPeriodsResponse};

/// A period.
pub(super) const fn period(echo: PeriodEcho) -> proto::Period {
    proto::Period {
        p: echo.p,
        q: echo.q,
        points: echo.points,
        side: echo.side,
    }
}

/// The list for a request.
pub(super) fn list(
    request: ListPeriodsRequest,
    service: &Service,
) -> Result<ListPeriodsResponse, Error> {
    let given: [(&'static Parameter, Option<Value>); 5] = [
        (&PROFILE, request.profile.map(Value::Text)),
        (&ALPHA, request.alpha.map(Value::Text)),
        (&MAP, request.map.map(Value::Text)),
        (&PERIODIC, request.periodic.map(Value::Integer)),
        (&MOST, request.most.map(Value::Integer)),
    ];
    let mut values = Values::new(groups::PERIODS, "");
    values.add_values(given);
    let found = Periods::of(&values, &service.catalog())?;
    Ok(ListPeriodsResponse {
        alpha: found.alpha,
        map: found.map,
        radius: found.radius,
        most_points: found.most_points,
        periods: found.periods.into_iter().map(period).collect(),
    })
}
