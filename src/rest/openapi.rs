//! `GET /openapi.json`: the description of the REST API, for programs.

use axum::routing;
use http::{HeaderMap, Method, Uri};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    fixed::Fixed,
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
    let document = Fixed::new("application/json", text.into());
    let answer = move |uri: Uri, headers: HeaderMap| async move { document.answer(&uri, &headers) };
    let handler = routing::get(answer);
    Endpoint::new(PATH, (), vec![(operation(), handler)]).open()
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
