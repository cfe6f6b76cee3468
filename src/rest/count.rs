//! `GET` and `POST /v1/count`: the exact number of points of a query, without making them.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use http::Method;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::json;
use strew_core::server::Stop;
use strew_error::{Error, Kind, integer::Long};
use strew_query::{Draft, Group, Query, Resolved, groups};
use strew_service::Service;

use super::{
    answer,
    api::{
        self, Endpoint, Operation, Tag,
        schemas::{self, CountQuery},
    },
    body,
    context::{Context, Sent},
    document, query,
};
use crate::{body::Response, rest::Refused};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let about = "Exact, in closed form for a box without warp, whatever it holds; otherwise in time \
                 proportional to its rows.";
    let answers = || api::Answer::json::<Count>("The count.");
    let given = Operation {
        id: "getCount",
        summary: "The number of points of a region",
        about,
        parameters: groups::COUNT,
        problems: problems(),
        example: "'/v1/count?bbox=-5e8,-5e8,5e8,5e8&spacing=1'".into(),
        ..Operation::new(Tag::Points, answers().or_unchanged())
    };
    let posted = Operation {
        method: Method::POST,
        id: "countPoints",
        summary: "The number of points of a query",
        about,
        body: Some(query::body(
            schemas::of::<CountQuery>,
            json!({ "region": { "circle": { "center": [0, 0], "radius": 9 } }, "spacing": 1 }),
        )),
        problems: [problems(), vec![Kind::BodyTooLarge]].concat(),
        example: r#"/v1/count -d '{"region": {"circle": {"center": [0, 0], "radius": 9}}, "spacing": 1}'"#
            .into(),
        ..Operation::new(Tag::Points, vec![answers()])
    };
    Endpoint::new("/v1/count")
        .with(service.clone(), given, get)
        .with(service, posted, post)
}

/// The problems of counting.
pub(super) fn problems() -> Vec<Kind> {
    vec![
        Kind::Invalid,
        Kind::OtherTable,
        Kind::OtherWorld,
        Kind::TooManyRows,
        Kind::TooManyPoints,
    ]
}

/// The exact number of points of a query.
#[derive(Serialize, JsonSchema)]
pub(super) struct Count {
    /// The number of points.
    count: Long<u128>,
    /// The query with everything filled in.
    query: Resolved,
}

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    given(&service, &context, groups::COUNT).await
}

async fn post(State(service): State<Arc<Service>>, sent: Sent) -> Result<Response, Refused> {
    posted(&service, sent, groups::COUNTED).await
}

/// Counts the query of an address.
pub(super) async fn given(
    service: &Service,
    context: &Context,
    groups: &'static [Group],
) -> Result<Response, Refused> {
    let draft = Draft::of(context.values(groups));
    let (query, _) = service.check(&draft, &Stop::NEVER)?;
    let freshness = answer::freshness(service, context, &query, document::JSON);
    let make = pin!(counted(service, context, query));
    Ok(freshness.answer(&context.headers, make).await?)
}

/// Counts the query of a body.
pub(super) async fn posted(
    service: &Arc<Service>,
    sent: Sent,
    groups: &'static [Group],
) -> Result<Response, Refused> {
    let Sent { context, body } = sent;
    let (_, query, _) = body::query(service, body, groups).await?;
    Ok(counted(service, &context, query).await?)
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
