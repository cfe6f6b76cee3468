//! `GET /openapi.json`: what the REST door answers, for programs.

use axum::{body::Body, response::Response, routing};
use bytes::Bytes;
use http::{HeaderValue, Method, header};
use serde_json::json;

use super::api::{self, Endpoint, Operation};

const PATH: &str = "/openapi.json";

/// The path, with the description of these endpoints and itself.
pub(super) fn endpoint(endpoints: &[Endpoint]) -> Endpoint {
    let alone = || Endpoint::new(PATH, (), vec![(operation(), routing::get(|| async {}))]);
    let mut document = api::document(endpoints);
    let own = api::document(&[alone()]);
    document["paths"][PATH] = own["paths"][PATH].clone();
    let mut text = serde_json::to_vec_pretty(&document).unwrap_or_default();
    text.push(b'\n');
    let text = Bytes::from(text);
    let handler = routing::get(move || {
        let text = text.clone();
        async move {
            let mut response = Response::new(Body::from(text));
            let json = HeaderValue::from_static("application/json");
            response.headers_mut().insert(header::CONTENT_TYPE, json);
            response
        }
    });
    Endpoint::new(PATH, (), vec![(operation(), handler)])
}

fn operation() -> Operation {
    Operation {
        method: Method::GET,
        id: "getOpenapi",
        summary: "This document",
        about: "OpenAPI 3.1. The page /docs shows it.",
        path_parameters: &[],
        parameters: vec![],
        body: None,
        answers: vec![api::Answer {
            status: 200,
            about: "The document.",
            headers: vec![],
            contents: vec![("application/json".into(), json!({ "type": "object" }))],
        }],
        problems: vec![],
        example: PATH.into(),
    }
}
