//! The exact number of points of a query, without making them, and the query in parts, for readers in parallel; in the
//! plane and in space.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use http::Method;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value, json};
use strew_catalog::Dimension;
use strew_core::server::Stop;
use strew_error::{Error, Kind, integer::Long};
use strew_query::{Draft, Query, Resolved, Token, groups, parts};
use strew_service::Service;

use super::{
    answer,
    api::{
        self, Endpoint, Operation, Tag,
        schemas::{self, AnyQuery, CountQuery, PointsQuery, SpaceQuery},
    },
    body,
    context::{Context, Posted, Sent},
    document,
};
use crate::{body::Response, rest::Refused};

/// The problems of counting.
fn problems(more: &[Kind]) -> Vec<Kind> {
    let counting = [
        Kind::Invalid,
        Kind::OtherTable,
        Kind::OtherWorld,
        Kind::TooManyRows,
        Kind::TooManyPoints,
    ];
    [&counting, more].concat()
}

/// The path of counts of a dimension.
pub(super) fn counts(service: &Arc<Service>, dimension: Dimension) -> Endpoint {
    let answers = || api::Answer::json::<Count>("The count.");
    let given = Operation {
        problems: problems(&[]),
        ..Operation::new(Tag::of(dimension), answers().or_unchanged())
    };
    let posted = Operation {
        method: Method::POST,
        problems: problems(&[Kind::BodyTooLarge]),
        ..Operation::new(Tag::of(dimension), vec![answers()])
    };
    let (path, members, given, posted) = match dimension {
        Dimension::Plane => {
            let about = "Exact, in closed form for a box without warp, whatever it holds; otherwise in time \
                         proportional to its rows.";
            let given = Operation {
                id: "getCount",
                summary: "The number of points of a region",
                about,
                parameters: groups::COUNT,
                example: "'/v1/count?bbox=-5e8,-5e8,5e8,5e8&spacing=1'".into(),
                ..given
            };
            let region = json!({ "circle": { "center": [0, 0], "radius": 9 } });
            let posted = Operation {
                id: "countPoints",
                summary: "The number of points of a query",
                about,
                body: Some(api::Body::json(
                    schemas::of::<CountQuery>,
                    json!({ "region": region, "spacing": 1 }),
                )),
                example: r#"/v1/count -d '{"region": {"circle": {"center": [0, 0], "radius": 9}}, "spacing": 1}'"#
                    .into(),
                ..posted
            };
            ("/v1/count", groups::COUNTED, given, posted)
        }
        Dimension::Space => {
            let about = "Exact, in a fraction of a millisecond for a box without warp, whatever it holds; otherwise \
                         in time proportional to its surface.";
            let given = Operation {
                id: "getSpaceCount",
                summary: "The number of points of a volume",
                about,
                parameters: groups::SPACE_COUNT,
                example: "'/v1/space/count?bbox=-5e8,-5e8,-5e8,5e8,5e8,5e8&spacing=1'".into(),
                ..given
            };
            let region = json!({ "ball": { "center": [0, 0, 0], "radius": 9 } });
            let body = json!({ "region": region, "spacing": 1 });
            let posted = Operation {
                id: "countSpacePoints",
                summary: "The number of points of a query in space",
                about,
                example: format!("/v1/space/count -d '{body}'"),
                body: Some(api::Body::json(schemas::of::<SpaceQuery>, body)),
                ..posted
            };
            ("/v1/space/count", groups::SPACE_QUERY, given, posted)
        }
    };
    let parameters = given.parameters;
    let get = move |State(service): State<Arc<Service>>, context: Context| async move {
        let draft = Draft::of(context.values(parameters));
        let (query, _) = service.check(&draft, &Stop::NEVER)?;
        let freshness = answer::freshness(&service, &context, &query, document::JSON);
        let make = pin!(counted(&service, &context, query));
        Ok::<_, Refused>(freshness.answer(&context.headers, make).await?)
    };
    let post = move |State(service): State<Arc<Service>>, Sent { context, body }: Sent| async move {
        let (_, query, _) = body::query(&service, body, members).await?;
        Ok::<_, Refused>(counted(&service, &context, query).await?)
    };
    Endpoint::only(path, service.clone(), given, get).with(service.clone(), posted, post)
}

/// The exact number of points of a query.
#[derive(Serialize, JsonSchema)]
struct Count {
    /// The number of points.
    count: Long<u128>,
    /// The query with everything filled in.
    query: Resolved,
}

async fn counted(
    service: &Service,
    context: &Context,
    query: Box<Query>,
) -> Result<Response, Error> {
    let planned = service.count(&context.caller, query).await?;
    document::json(&Count {
        count: Long(planned.count()),
        query: planned.resolved(),
    })
}

/// The path of parts of a dimension.
pub(super) fn parts_of(service: &Arc<Service>, dimension: Dimension) -> Endpoint {
    let operation = Operation {
        method: Method::POST,
        parameters: groups::SPLIT,
        problems: problems(&[Kind::BodyTooLarge]),
        ..Operation::new(
            Tag::of(dimension),
            vec![api::Answer::json::<Split>("The parts.")],
        )
    };
    let (path, members, operation) = match dimension {
        Dimension::Plane => (
            "/v1/points:split",
            groups::QUERY,
            Operation {
                id: "splitPoints",
                summary: "A query in parts",
                about: "Queries of equal numbers of points, give or take one, that together return the points of the \
                        query in its order; each is a body of POST /v1/points:query. Parts without points are \
                        left out.",
                body: Some(api::Body::json(
                    schemas::of::<PointsQuery>,
                    json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1 }),
                )),
                example: r#"'/v1/points:split?parts=2' -d '{"region": {"bbox": [0, 0, 9, 9]}, "spacing": 1}'"#.into(),
                ..operation
            },
        ),
        Dimension::Space => {
            let body = json!({ "region": { "bbox": [0, 0, 0, 4, 4, 4] }, "spacing": 1 });
            let operation = Operation {
                id: "splitSpacePoints",
                summary: "A query in space in parts",
                about: "Queries of equal numbers of points, give or take one, that together return the points of the \
                        query in its order; each is a body of POST /v1/space/points. Parts without points are left \
                        out.",
                example: format!("'/v1/space/points:split?parts=2' -d '{body}'"),
                body: Some(api::Body::json(schemas::of::<SpaceQuery>, body)),
                ..operation
            };
            ("/v1/space/points:split", groups::SPACE_QUERY, operation)
        }
    };
    let post = move |State(service): State<Arc<Service>>, Posted { context, body }: Posted| async move {
        let parts = parts(&context.values(groups::SPLIT));
        let size = body.len();
        let (draft, query, _) = body::query(&service, body, members).await?;
        split(&service, &context, parts?, size, draft, query).await
    };
    Endpoint::only(path, service.clone(), operation, post)
}

/// A query in parts.
#[derive(Serialize, JsonSchema)]
struct Split {
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

/// The bytes of a part besides the body: a cursor, a limit, a count.
const PART_BYTES: usize = 512;

/// Splits a query that came in `size` bytes.
async fn split(
    service: &Arc<Service>,
    context: &Context,
    parts: u32,
    size: usize,
    draft: Draft,
    query: Box<Query>,
) -> Result<Response, Refused> {
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
