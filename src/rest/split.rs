//! `POST /v1/points:split`: a query in parts, for readers in parallel.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::{Method, Uri};
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::{
    api::{self, Endpoint, Operation, schemas},
    body::Whole,
    document, query,
};
use crate::service::{Error, Kind, Service, query::parse_pairs};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let part = schemas::object(json!({
        "count": { "type": "integer", "minimum": 1 },
        "query": schemas::reference("PointsQuery"),
    }));
    let schema = schemas::object(json!({
        "count": { "type": "integer", "minimum": 0 },
        "parts": { "type": "array", "items": part },
    }));
    let operation = Operation {
        method: Method::POST,
        id: "splitPoints",
        summary: "A query in parts",
        about: "Queries of as many points, give or take one, that give the points of the query one \
                after another; each is a body of POST /v1/points:query. Parts without points are \
                left out.",
        path_parameters: &[],
        parameters: api::given(&["parts"], &[]),
        body: Some(query::body()),
        answers: vec![api::Answer {
            status: 200,
            about: "The parts.",
            headers: vec![],
            contents: vec![(document::JSON.into(), schema)],
        }],
        problems: vec![
            Kind::Invalid,
            Kind::OtherTable,
            Kind::TooManyRows,
            Kind::TooManyPoints,
            Kind::BodyTooLarge,
        ],
        example:
            r#"'/v1/points:split?parts=2' -d '{"region": {"bbox": [0, 0, 9, 9]}, "spacing": 1}'"#
                .into(),
    };
    let handler = routing::post(post);
    Endpoint::new("/v1/points:split", service, vec![(operation, handler)])
}

#[derive(Serialize)]
struct Split {
    count: u128,
    parts: Vec<Part>,
}

#[derive(Serialize)]
struct Part {
    count: u64,
    query: Map<String, Value>,
}

async fn post(
    State(service): State<Arc<Service>>,
    uri: Uri,
    Whole(body): Whole,
) -> Result<Response, Error> {
    let (parameters, mut faults) = parse_pairs(uri.query().unwrap_or_default());
    let parts = parameters.parts().map_err(|more| faults.extend(more));
    let (Ok(parts), true) = (parts, faults.is_empty()) else {
        return Err(Error::Invalid(faults));
    };
    let (query, _) = query::read(&service, body.clone()).await?;
    let planned = service.count(query).await?;
    let count = planned.count();
    let places = service.split(planned, parts).await?;
    // Each part repeats the body, in memory and in the answer.
    let bytes = places.len().saturating_mul(body.len() + PART_BYTES);
    let _held = service.hold(bytes.saturating_mul(3))?;
    let write = move |_: &Service| {
        let mut asked: Map<String, Value> = serde_json::from_slice(&body)
            .map_err(|_| Error::Internal("a body that was read is gone"))?;
        asked.remove("offset");
        let part = |(token, count): (crate::service::Token, u64)| {
            let mut query = asked.clone();
            query.insert("cursor".into(), token.to_string().into());
            query.insert("limit".into(), count.into());
            Part { count, query }
        };
        document::json(&Split {
            count,
            parts: places.into_iter().map(part).collect(),
        })
    };
    service.process(bytes, write).await?
}

/// What a part takes besides the body: a cursor, a limit, a count.
const PART_BYTES: usize = 512;
