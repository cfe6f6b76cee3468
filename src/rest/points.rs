//! `GET /v1/points`: the points of a region, streamed.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::{HeaderMap, Method, Uri};

use super::{
    answer::{self, Asked},
    api::{self, Endpoint, Operation},
};
use crate::access::Caller;
use crate::service::{
    Error, Service,
    query::{LOOKS_NAMES, REGION_NAMES, SET_NAMES, WINDOW_NAMES, parse_pairs},
};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::GET,
        id: "getPoints",
        summary: "The points of a region",
        about: "Streams every point of a half-open box, a circle or a polygon, in a fixed order. The \
                exact count is in the header strew-count before any point is made.",
        path_parameters: &[],
        parameters: api::given(
            &[],
            &[&REGION_NAMES[..], &SET_NAMES, &WINDOW_NAMES, &LOOKS_NAMES].concat(),
        ),
        body: None,
        answers: vec![answer::told(), api::Answer::unchanged()],
        problems: answer::problems(),
        example: "'/v1/points?bbox=0,0,3,2&spacing=1&format=csv'".into(),
    };
    Endpoint::new("/v1/points", service, vec![(operation, routing::get(get))])
}

/// Answers a query.
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
    let asked = Asked {
        caller,
        method,
        uri,
        headers,
    };
    answer::stream(&service, &asked, query, options).await
}
