//! `POST /v1/points:query`: the points of any region and of several layers, asked for in JSON.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::Method;
use serde_json::json;

use super::{
    answer,
    api::{
        Body, Endpoint, Operation, Tag,
        schemas::{self, Content, PointsQuery},
    },
    body::{self, Whole},
    context::Context,
};
use crate::service::{Error, Kind, Service, query::groups};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::POST,
        id: "queryPoints",
        summary: "The points of any region, in layers",
        about: "The same as GET /v1/points, with regions of all kinds and several layers at once, \
                streamed one after another in one answer.",
        tag: Tag::Points,
        path_parameters: &[],
        parameters: groups::NONE,
        body: Some(body(schemas::of::<PointsQuery>, example())),
        answers: vec![answer::described()],
        problems: [answer::problems(), vec![Kind::BodyTooLarge]].concat(),
        example: format!("/v1/points:query -d '{}'", example()),
    };
    let handler = routing::post(post);
    Endpoint::new("/v1/points:query", service, vec![(operation, handler)])
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

async fn post(
    State(service): State<Arc<Service>>,
    context: Context,
    Whole(body): Whole,
) -> Result<Response, Error> {
    context.no_parameters()?;
    let (_, query, options) = body::query(&service, body, groups::QUERY).await?;
    answer::stream(&service, &context, query, options).await
}
