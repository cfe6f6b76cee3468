//! `GET /v1/periods`: the periods that a table has.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use strew_error::Kind;
use strew_query::{Periods, groups};
use strew_service::Service;

use super::{
    api::{self, Endpoint, Operation, Tag},
    context::Context,
    document,
};
use crate::{body::Response, rest::Refused};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "listPeriods",
        summary: "The periods of a table",
        about: "The sizes of periodic sets, smallest first: with periodic, from that number of points on.",
        parameters: groups::PERIODS,
        problems: vec![Kind::Invalid, Kind::OtherTable],
        example: "'/v1/periods?periodic=20000&most=3'".into(),
        ..Operation::new(
            Tag::Profiles,
            api::Answer::json::<Periods>("The list.").or_unchanged(),
        )
    };
    Endpoint::only("/v1/periods", service, operation, get)
}

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let periods = Periods::of(&context.values(groups::PERIODS), &service.catalog())?;
    let made_of = (&periods.alpha, periods.radius);
    let make = async { document::json(&periods) };
    Ok(context.answer(document::JSON, &made_of, pin!(make)).await?)
}
