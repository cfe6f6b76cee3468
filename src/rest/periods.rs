//! `GET /v1/periods`: the periods that a table has.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::Method;

use super::{
    api::{self, Endpoint, Operation, Tag},
    context::Context,
    document,
    freshness::Freshness,
};
use crate::service::{
    Error, Kind, Service,
    query::{Periods, groups},
};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::GET,
        id: "listPeriods",
        summary: "The periods of a table",
        about: "The sizes of periodic sets, smallest first: with periodic, from that number of points on.",
        tag: Tag::Profiles,
        path_parameters: &[],
        parameters: groups::PERIODS,
        body: None,
        answers: vec![
            api::Answer::json::<Periods>("The list."),
            api::Answer::unchanged(),
        ],
        problems: vec![Kind::Invalid, Kind::OtherTable],
        example: "'/v1/periods?periodic=20000&most=3'".into(),
    };
    Endpoint::new("/v1/periods", service, vec![(operation, routing::get(get))])
}

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Error> {
    let periods = Periods::of(&context.values(groups::PERIODS), &service.catalog())?;
    let made_of = (&periods.alpha, periods.radius);
    let freshness = Freshness::of(&context.uri, &context.headers, document::JSON, &made_of);
    freshness
        .answer(&context.headers, async { document::json(&periods) })
        .await
}
