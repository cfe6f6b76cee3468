//! `POST /v1/points:split`: a query in parts, for readers in parallel.

use std::sync::Arc;

use axum::extract::State;
use bytes::Bytes;
use http::Method;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value, json};
use strew_core::server::Stop;
use strew_error::{Kind, integer::Long};
use strew_query::{Group, Token, groups, parts};
use strew_service::Service;

use super::{
    api::{
        self, Endpoint, Operation, Tag,
        schemas::{self, AnyQuery, PointsQuery},
    },
    body,
    context::{Context, Posted},
    document, query,
};
use crate::{body::Response, rest::Refused};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::POST,
        id: "splitPoints",
        summary: "A query in parts",
        about: "Queries of equal numbers of points, give or take one, that together return the points of the \
                query in its order; each is a body of POST /v1/points:query. Parts without points are \
                left out.",
        parameters: groups::SPLIT,
        body: Some(query::body(
            schemas::of::<PointsQuery>,
            json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1 }),
        )),
        problems: vec![
            Kind::Invalid,
            Kind::OtherTable,
            Kind::OtherWorld,
            Kind::TooManyRows,
            Kind::TooManyPoints,
            Kind::BodyTooLarge,
        ],
        example:
            r#"'/v1/points:split?parts=2' -d '{"region": {"bbox": [0, 0, 9, 9]}, "spacing": 1}'"#
                .into(),
        ..Operation::new(Tag::Points, vec![api::Answer::json::<Split>("The parts.")])
    };
    Endpoint::only("/v1/points:split", service, operation, post)
}

/// A query in parts.
#[derive(Serialize, JsonSchema)]
pub(super) struct Split {
    /// The number of points of all parts.
    count: Long<u128>,
    /// The parts in their order.
    parts: Vec<Part>,
}

/// A part of a query.
#[derive(Serialize, JsonSchema)]
struct Part {
    /// The number of points of the part.
    count: Long<u64>,
    /// The body of POST /v1/points:query, in space of POST /v1/space/points, that requests it.
    #[schemars(with = "AnyQuery")]
    query: Map<String, Value>,
}

async fn post(
    State(service): State<Arc<Service>>,
    Posted { context, body }: Posted,
) -> Result<Response, Refused> {
    posted(service, context, body, groups::QUERY).await
}

/// Splits the query of a body.
pub(super) async fn posted(
    service: Arc<Service>,
    context: Context,
    body: Bytes,
    groups: &'static [Group],
) -> Result<Response, Refused> {
    let parts = parts(&context.values(groups::SPLIT));
    let size = body.len();
    let (draft, query, _) = body::query(&service, body, groups).await?;
    let parts = parts?;
    let planned = service.count(&context.caller, query).await?;
    let count = planned.count();
    let places = service.split(&context.caller, planned, parts).await?;
    // Each part repeats the body, in memory and in the answer.
    let bytes = places.len().saturating_mul(size + PART_BYTES);
    let _held = service.hold(bytes.saturating_mul(3))?;
    let write = move |_: &Service, _: &Stop| {
        let part = |(token, count): (Token, u64)| Part {
            count: Long(count),
            query: draft.part(&token, count).to_body(),
        };
        document::json(&Split {
            count: Long(count),
            parts: places.into_iter().map(part).collect(),
        })
    };
    Ok(service.process(bytes, write).await??)
}

/// The bytes of a part besides the body: a cursor, a limit, a count.
const PART_BYTES: usize = 512;
