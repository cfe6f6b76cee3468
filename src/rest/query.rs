//! `POST /v1/points:query`: the points of any region and of several layers, asked for in JSON.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use bytes::Bytes;
use http::{HeaderMap, Method, Uri};
use serde_json::json;

use super::{
    answer::{self, Asked},
    api::{Body, Endpoint, Operation, schemas},
    body::Whole,
};
use crate::access::Caller;
use crate::service::{Error, Fault, Kind, Query, Service, encode::Options, query::read_body};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::POST,
        id: "queryPoints",
        summary: "The points of any region, in layers",
        about: "The same as GET /v1/points, with regions of all kinds and several layers at once, \
                streamed one after another in one answer.",
        path_parameters: &[],
        parameters: vec![],
        body: Some(body()),
        answers: vec![answer::told()],
        problems: [answer::problems(), vec![Kind::BodyTooLarge]].concat(),
        example: format!("/v1/points:query -d '{}'", example()),
    };
    let handler = routing::post(post);
    Endpoint::new("/v1/points:query", service, vec![(operation, handler)])
}

/// A query as the body of a request.
pub(super) fn body() -> Body {
    Body {
        media_type: "application/json",
        schema: schemas::reference("PointsQuery"),
        example: example(),
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
    caller: Caller,
    method: Method,
    uri: Uri,
    headers: HeaderMap,
    Whole(body): Whole,
) -> Result<Response, Error> {
    no_parameters(&uri)?;
    let (query, options) = read(&service, body).await?;
    let asked = Asked {
        caller,
        method,
        uri,
        headers,
    };
    answer::stream(&service, &asked, query, options).await
}

/// The checked query of a body.
pub(super) async fn read(service: &Arc<Service>, body: Bytes) -> Result<(Query, Options), Error> {
    let bytes = body.len();
    let read = move |service: &Service| {
        let body = read_body(&body)?;
        let most_vertices = service.limits().max_vertices;
        let query = body
            .draft
            .check(&service.catalog(), most_vertices, body.faults)?;
        Ok((query, body.options))
    };
    service.process(bytes, read).await?
}

/// Everything is in the body.
pub(super) fn no_parameters(uri: &Uri) -> Result<(), Error> {
    match uri.query().filter(|text| !text.is_empty()) {
        Some(text) => {
            let detail = "the query is in the body";
            Err(Error::Invalid(vec![Fault::new(
                "query", text, detail, "none",
            )]))
        }
        None => Ok(()),
    }
}
