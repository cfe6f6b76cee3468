//! `GET /openapi.json`: what the REST door answers, for programs.

use axum::{body::Body, response::Response, routing};
use bytes::Bytes;
use http::{HeaderMap, HeaderValue, Method, Uri, header};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    freshness::Freshness,
};
use crate::service::query::groups;

const PATH: &str = "/openapi.json";

/// The path, with the description of these endpoints and itself.
pub(super) fn endpoint(endpoints: &[Endpoint]) -> Endpoint {
    let alone = || Endpoint::new(PATH, (), vec![(operation(), routing::get(|| async {}))]).open();
    let mut document = api::document(endpoints);
    let own = api::document(&[alone()]);
    document["paths"][PATH] = own["paths"][PATH].clone();
    let mut text = serde_json::to_vec_pretty(&document).unwrap_or_default();
    text.push(b'\n');
    let text = Bytes::from(text);
    let handler = routing::get(move |uri, headers| {
        let text = text.clone();
        async move { fixed(&uri, &headers, "application/json", text) }
    });
    Endpoint::new(PATH, (), vec![(operation(), handler)]).open()
}

/// An answer that is always the same.
pub(super) fn fixed(
    uri: &Uri,
    headers: &HeaderMap,
    content_type: &'static str,
    content: Bytes,
) -> Response {
    let digest = blake3::hash(&content).to_hex();
    let freshness = Freshness::of(uri, headers, content_type, &digest.as_str());
    let unchanged = freshness.unchanged(headers);
    if let Some(unchanged) = unchanged.or_else(|| freshness.unwanted(headers)) {
        return unchanged;
    }
    let mut response = Response::new(Body::from(content));
    let value = HeaderValue::from_static(content_type);
    response.headers_mut().insert(header::CONTENT_TYPE, value);
    freshness.stamp(&mut response);
    response
}

fn operation() -> Operation {
    Operation {
        method: Method::GET,
        id: "getOpenapi",
        summary: "This document",
        about: "OpenAPI 3.1. The page /docs shows it.",
        tag: Tag::About,
        path_parameters: &[],
        parameters: groups::NONE,
        body: None,
        answers: vec![
            api::Answer {
                status: 200,
                about: "The document.",
                headers: vec![],
                contents: vec![("application/json", schemas::object)],
            },
            api::Answer::unchanged(),
        ],
        problems: vec![],
        example: PATH.into(),
    }
}
