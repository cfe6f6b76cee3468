//! `POST /v1/points:query`: the points of any region and of several layers, from a query in JSON.

use std::sync::Arc;

use axum::extract::State;
use http::Method;
use serde_json::json;
use strew_error::Kind;
use strew_query::groups;
use strew_service::Service;

use super::{
    answer,
    api::{
        Body, Endpoint, Operation, Tag,
        schemas::{self, Content, PointsQuery},
    },
    body,
    context::Sent,
};
use crate::{body::Response, rest::Refused};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::POST,
        id: "queryPoints",
        summary: "The points of any region, in layers",
        about: "The same as GET /v1/points, with regions of all kinds and several layers at once, \
                streamed one after another in one answer.",
        body: Some(body(schemas::of::<PointsQuery>, example())),
        problems: [answer::problems(), vec![Kind::BodyTooLarge]].concat(),
        example: format!("/v1/points:query -d '{}'", example()),
        ..Operation::new(Tag::Points, vec![answer::described()])
    };
    Endpoint::only("/v1/points:query", service, operation, post)
}

/// A query as the body of a request, with its schema and an example.
pub(super) fn body(schema: Content, example: serde_json::Value) -> Body {
    Body {
        media_type: "application/json",
        schema,
        example,
    }
}

fn example() -> serde_json::Value {
    json!({
        "region": { "circle": { "center": [10, 10], "radius": 4 } },
        "layers": [
            { "name": "trees", "spacing": 2, "seed": 1, "attributes": ["angle"] },
            { "name": "rocks", "spacing": 1, "seed": 2, "clear_of": { "trees": 0.8 } },
        ],
        "format": "csv",
    })
}

async fn post(State(service): State<Arc<Service>>, sent: Sent) -> Result<Response, Refused> {
    let Sent { context, body } = sent;
    let (_, query, options) = body::query(&service, body, groups::QUERY).await?;
    Ok(answer::stream(&service, &context, query, options).await?)
}
