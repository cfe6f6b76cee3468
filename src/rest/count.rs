//! `GET` and `POST /v1/count`: how many points a query has, exactly, without making them.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::Method;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::json;
use strew_core::server::Stop;

use super::{
    answer,
    api::{
        self, Endpoint, Operation, Tag,
        schemas::{self, CountQuery},
    },
    body::{self, Whole},
    context::Context,
    document, query,
};
use crate::service::{
    Draft, Error, Kind, Query, Service,
    query::{Resolved, groups},
};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let about = "Exact, in closed form for a box without warp, whatever it holds; otherwise in time \
                 proportional to its rows.";
    let answers = || api::Answer::json::<Count>("The count.");
    let problems = || {
        vec![
            Kind::Invalid,
            Kind::OtherTable,
            Kind::OtherWorld,
            Kind::TooManyRows,
            Kind::TooManyPoints,
        ]
    };
    let given = Operation {
        method: Method::GET,
        id: "getCount",
        summary: "How many points a region holds",
        about,
        tag: Tag::Points,
        path_parameters: &[],
        parameters: groups::COUNT,
        body: None,
        answers: vec![answers(), api::Answer::unchanged()],
        problems: problems(),
        example: "'/v1/count?bbox=-5e8,-5e8,5e8,5e8&spacing=1'".into(),
    };
    let posted = Operation {
        method: Method::POST,
        id: "countPoints",
        summary: "How many points a query has",
        about,
        tag: Tag::Points,
        path_parameters: &[],
        parameters: groups::NONE,
        body: Some(query::body(
            schemas::of::<CountQuery>,
            json!({ "region": { "circle": { "center": [0, 0], "radius": 9 } }, "spacing": 1 }),
        )),
        answers: vec![answers()],
        problems: [problems(), vec![Kind::BodyTooLarge]].concat(),
        example: r#"/v1/count -d '{"region": {"circle": {"center": [0, 0], "radius": 9}}, "spacing": 1}'"#
            .into(),
    };
    let operations = vec![(given, routing::get(get)), (posted, routing::post(post))];
    Endpoint::new("/v1/count", service, operations)
}

/// The exact number of points of a query.
#[derive(Serialize, JsonSchema)]
struct Count {
    /// The number of points.
    count: u128,
    /// The query with everything filled in.
    query: Resolved,
}

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Error> {
    let draft = Draft::of(context.values(groups::COUNT));
    let (query, _) = service.check(&draft, &Stop::NEVER)?;
    let freshness = answer::freshness(&service, &context, &query, document::JSON);
    freshness
        .answer(&context.headers, counted(&service, &context, query))
        .await
}

async fn post(
    State(service): State<Arc<Service>>,
    context: Context,
    Whole(body): Whole,
) -> Result<Response, Error> {
    context.no_parameters()?;
    let (_, query, _) = body::query(&service, body, groups::COUNTED).await?;
    counted(&service, &context, query).await
}

async fn counted(service: &Service, context: &Context, query: Query) -> Result<Response, Error> {
    let planned = service.count(&context.caller, query).await?;
    document::json(&Count {
        count: planned.count(),
        query: planned.resolved(),
    })
}
