//! `GET /v1/points`: the points of a region, streamed.

use std::sync::Arc;

use axum::extract::State;
use strew_core::server::Stop;
use strew_query::{Draft, groups};
use strew_service::Service;

use super::{
    answer,
    api::{Endpoint, Operation, Tag},
    context::Context,
};
use crate::{body::Response, rest::Refused};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getPoints",
        summary: "The points of a region",
        about: "Streams every point of a half-open box, a circle or a polygon, in a fixed order. The \
                exact count is in the header strew-count before any point is made.",
        parameters: groups::POINTS,
        problems: answer::problems(),
        example: "'/v1/points?bbox=0,0,3,2&spacing=1&format=csv'".into(),
        ..Operation::new(Tag::Points, answer::described().or_unchanged())
    };
    Endpoint::only("/v1/points", service, operation, get)
}

/// Answers a query.
async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let draft = Draft::of(context.values(groups::POINTS));
    let (query, options) = service.check(&draft, &Stop::NEVER)?;
    Ok(answer::stream(&service, &context, query, options).await?)
}
