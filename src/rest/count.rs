//! The exact number of points of a query, without making them, and the query in parts, for readers in parallel; in the
//! plane and in space.

use std::{pin::pin, sync::Arc};

use axum::extract::State;

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
        self, Endpoint, Operation, Tag, either,
        schemas::{self, AnyQuery, CountQuery, PointsQuery, SpaceQuery},
    },
    context::{Answered, Context, Posted, Sent, Shared, query_of_body},
    document,
};
use crate::{body::Response, rest::Refused};

const PROBLEMS: [Kind; 5] = [
    Kind::Invalid,
    Kind::OtherTable,
    Kind::OtherWorld,
    Kind::TooManyRows,
    Kind::TooManyPoints,
];

pub(super) fn counts(service: &Arc<Service>, dimension: Dimension) -> Endpoint {
    let path = either(dimension, ["/v1/count", "/v1/space/count"]);
    let parameters = either(dimension, [groups::COUNT, groups::SPACE_COUNT]);
    let members = either(dimension, [groups::COUNTED, groups::SPACE_QUERY]);
    let about = [
        "Exact, in closed form for a box without warp, whatever it holds; otherwise in time proportional to its rows.",
        "Exact, in a fraction of a millisecond for a box without warp, whatever it holds; otherwise in time \
         proportional to its surface.",
    ];
    let summary = [
        "The number of points of a region",
        "The number of points of a volume",
    ];
    let example = [
        "'/v1/count?bbox=-5e8,-5e8,5e8,5e8&spacing=1'",
        "'/v1/space/count?bbox=-5e8,-5e8,-5e8,5e8,5e8,5e8&spacing=1'",
    ];
    let answers = || api::Answer::json::<Count>("The count.");
    let given = Operation {
        id: either(dimension, ["getCount", "getSpaceCount"]),
        summary: either(dimension, summary),
        about: either(dimension, about),
        parameters,
        problems: PROBLEMS.into(),
        example: either(dimension, example).into(),
        ..Operation::new(Tag::of(dimension), answers().or_unchanged())
    };
    let region = [
        json!({ "circle": { "center": [0, 0], "radius": 9 } }),
        json!({ "ball": { "center": [0, 0, 0], "radius": 9 } }),
    ];
    let body = json!({ "region": either(dimension, region), "spacing": 1 });
    let schemas = [schemas::of::<CountQuery>, schemas::of::<SpaceQuery>];
    let summary = [
        "The number of points of a query",
        "The number of points of a query in space",
    ];
    let posted = Operation {
        id: either(dimension, ["countPoints", "countSpacePoints"]),
        summary: either(dimension, summary),
        parameters: groups::NONE,
        answers: vec![answers()],
        ..given.clone().posted(path, either(dimension, schemas), body)
    };
    let get = move |State(service): Shared, context: Context| async move {
        let draft = Draft::of(context.values(parameters));
        let (query, _) = service.check(&draft, &Stop::NEVER)?;
        let freshness = answer::freshness(&service, &context, &query, document::JSON);
        let make = pin!(counted(&service, &context, query));
        Ok::<_, Refused>(freshness.answer(&context.headers, make).await?)
    };
    let post = move |State(service): Shared, Sent { context, body }: Sent| async move {
        let (_, query, _) = query_of_body(&service, body, members).await?;
        Ok::<_, Refused>(counted(&service, &context, query).await?)
    };
    Endpoint::only(path, service.clone(), given, get).with(service.clone(), posted, post)
}

/// The exact number of points of a query.
#[derive(Serialize, JsonSchema)]
pub struct Count {
    /// The number of points.
    pub count: Long<u128>,
    /// The query with everything filled in.
    pub query: Resolved,
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

pub(super) fn parts_of(service: &Arc<Service>, dimension: Dimension) -> Endpoint {
    let path = either(dimension, ["/v1/points:split", "/v1/space/points:split"]);
    let members = either(dimension, [groups::QUERY, groups::SPACE_QUERY]);
    let about = [
        "Queries of equal numbers of points, give or take one, that together return the points of the query in its \
         order; each is a body of POST /v1/points:query. Parts without points are left out.",
        "Queries of equal numbers of points, give or take one, that together return the points of the query in its \
         order; each is a body of POST /v1/space/points. Parts without points are left out.",
    ];
    let region = [
        json!({ "bbox": [0, 0, 9, 9] }),
        json!({ "bbox": [0, 0, 0, 4, 4, 4] }),
    ];
    let body = json!({ "region": either(dimension, region), "spacing": 1 });
    let schemas = [schemas::of::<PointsQuery>, schemas::of::<SpaceQuery>];
    let answers = vec![api::Answer::json::<Split>("The parts.")];
    let operation = Operation {
        id: either(dimension, ["splitPoints", "splitSpacePoints"]),
        summary: either(dimension, ["A query in parts", "A query in space in parts"]),
        about: either(dimension, about),
        parameters: groups::SPLIT,
        problems: PROBLEMS.into(),
        ..Operation::new(Tag::of(dimension), answers)
    };
    let example = format!("'{path}?parts=2'");
    let operation = operation.posted(&example, either(dimension, schemas), body);
    let post = move |State(service): Shared, Posted { context, body }: Posted| async move {
        let parts = parts(&context.values(groups::SPLIT));
        let size = body.len();
        let (draft, query, _) = query_of_body(&service, body, members).await?;
        split(&service, &context, parts?, size, draft, query).await
    };
    Endpoint::only(path, service.clone(), operation, post)
}

/// A query in parts.
#[derive(Serialize, JsonSchema)]
pub struct Split {
    /// The number of points of all parts.
    pub count: Long<u128>,
    /// The parts in their order.
    pub parts: Vec<Piece>,
}

/// A part of a query.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Part")]
pub struct Piece {
    /// The number of points of the part.
    pub count: Long<u64>,
    /// The body of POST /v1/points:query, in space of POST /v1/space/points, that requests it.
    #[schemars(with = "AnyQuery")]
    pub query: Map<String, Value>,
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
) -> Answered {
    let planned = service.count(&context.caller, query).await?;
    let count = planned.count();
    let places = service.split(&context.caller, planned, parts).await?;
    // Each part repeats the body, in memory and in the answer.
    let bytes = places.len().saturating_mul(size + PART_BYTES);
    let _held = service.hold(bytes.saturating_mul(3))?;
    let write = move |_: &Service, _: &Stop| {
        let part = |(token, count): (Token, u64)| Piece {
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
