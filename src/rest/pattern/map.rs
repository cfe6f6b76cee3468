//! `GET /v1/pattern/map`: neighborhood maps.

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
    pattern::{MapDocument, MapQuery},
    query::groups,
};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::GET,
        id: "getMap",
        summary: "A neighborhood map",
        about: "The intervals of index space along each axis, whose pairs are the blocks; all points of a block \
                have the same neighbors up to the half-width R. A larger R refines the map. The number of \
                intervals grows linearly, by 2(α − 1) for each grid unit.",
        tag: Tag::Patterns,
        path_parameters: &[],
        parameters: groups::MAP,
        body: None,
        answers: vec![
            api::Answer::json::<MapDocument>("The map."),
            api::Answer::unchanged(),
        ],
        problems: vec![Kind::Invalid],
        example: "'/v1/pattern/map?alpha=sqrt(3)&radius=10&refined=20&block=3,4'".into(),
    };
    let handler = routing::get(get);
    Endpoint::new("/v1/pattern/map", service, vec![(operation, handler)])
}

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Error> {
    let query = MapQuery::check(&context.values(groups::MAP))?;
    let freshness = Freshness::of(&context.uri, &context.headers, document::JSON, &());
    let make = service.map(&context.caller, query, |map| document::json(&map));
    freshness.answer(&context.headers, make).await
}
