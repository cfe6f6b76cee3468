//! `GET` and `POST /v1/count`: how many points a query has, exactly, without making them.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::{HeaderMap, Method, Uri};
use serde::Serialize;
use serde_json::json;

use super::{
    answer::{self, Asked},
    api::{self, Endpoint, Operation, schemas},
    body::Whole,
    document, query,
};
use crate::access::Caller;
use crate::service::{
    Error, Kind, Query, Service,
    query::{REGION_NAMES, Resolved, SET_NAMES, WINDOW_NAMES, parse_pairs},
};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let about = "Exact, in closed form for a box without warp, whatever it holds; otherwise in time \
                 proportional to its rows.";
    let answers = || {
        let schema = schemas::object(json!({
            "count": { "type": "integer", "minimum": 0 },
            "query": schemas::reference("Query"),
        }));
        api::Answer {
            status: 200,
            about: "The count.",
            headers: vec![],
            contents: vec![("application/json".into(), schema)],
        }
    };
    let problems = || {
        vec![
            Kind::Invalid,
            Kind::OtherTable,
            Kind::TooManyRows,
            Kind::TooManyPoints,
        ]
    };
    let given = Operation {
        method: Method::GET,
        id: "getCount",
        summary: "How many points a region holds",
        about,
        path_parameters: &[],
        parameters: api::given(
            &[],
            &[&REGION_NAMES[..], &SET_NAMES, &WINDOW_NAMES].concat(),
        ),
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
        path_parameters: &[],
        parameters: vec![],
        body: Some(query::body()),
        answers: vec![answers()],
        problems: [problems(), vec![Kind::BodyTooLarge]].concat(),
        example: r#"/v1/count -d '{"region": {"circle": {"center": [0, 0], "radius": 9}}, "spacing": 1}'"#
            .into(),
    };
    let operations = vec![(given, routing::get(get)), (posted, routing::post(post))];
    Endpoint::new("/v1/count", service, operations)
}

#[derive(Serialize)]
struct Count {
    count: u128,
    query: Resolved,
}

async fn get(
    State(service): State<Arc<Service>>,
    caller: Caller,
    method: Method,
    uri: Uri,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let (parameters, faults) = parse_pairs(uri.query().unwrap_or_default());
    let most_vertices = service.limits().max_vertices;
    let (query, options) = parameters.check(&service.catalog(), most_vertices, None, faults)?;
    document::no_looks(options)?;
    let asked = Asked {
        caller,
        method,
        uri,
        headers,
    };
    let freshness = answer::freshness(&service, &asked, &query, document::JSON)?;
    if let Some(unchanged) = freshness.unchanged(&asked.headers) {
        return Ok(unchanged);
    }
    let mut response = counted(&service, query).await?;
    if let Some(unwanted) = freshness.unwanted(&asked.headers) {
        return Ok(unwanted);
    }
    freshness.stamp(&mut response);
    Ok(response)
}

async fn post(
    State(service): State<Arc<Service>>,
    uri: Uri,
    Whole(body): Whole,
) -> Result<Response, Error> {
    query::no_parameters(&uri)?;
    let (query, options) = query::read(&service, body).await?;
    document::no_looks(options)?;
    counted(&service, query).await
}

async fn counted(service: &Service, query: Query) -> Result<Response, Error> {
    let planned = service.count(query).await?;
    document::json(&Count {
        count: planned.count(),
        query: planned.resolved(),
    })
}
