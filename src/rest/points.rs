//! `GET /v1/points`: the points of a region, streamed.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::Method;
use strew_core::server::Stop;

use super::{
    answer,
    api::{self, Endpoint, Operation, Tag},
    context::Context,
};
use crate::service::{Draft, Error, Service, query::groups};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::GET,
        id: "getPoints",
        summary: "The points of a region",
        about: "Streams every point of a half-open box, a circle or a polygon, in a fixed order. The \
                exact count is in the header strew-count before any point is made.",
        tag: Tag::Points,
        path_parameters: &[],
        parameters: groups::POINTS,
        body: None,
        answers: vec![answer::described(), api::Answer::unchanged()],
        problems: answer::problems(),
        example: "'/v1/points?bbox=0,0,3,2&spacing=1&format=csv'".into(),
    };
    Endpoint::new("/v1/points", service, vec![(operation, routing::get(get))])
}

/// Answers a query.
async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Error> {
    let draft = Draft::of(context.values(groups::POINTS));
    let (query, options) = service.check(&draft, &Stop::NEVER)?;
    answer::stream(&service, &context, query, options).await
}
