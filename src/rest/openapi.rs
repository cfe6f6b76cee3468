//! `GET /openapi.json`: the description of the REST API, for programs.

use http::{HeaderMap, Uri};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    fixed::Fixed,
};

const PATH: &str = "/openapi.json";

/// The path, with the description of these endpoints and itself.
pub(super) fn endpoint(endpoints: &[Endpoint]) -> Endpoint {
    let own = Endpoint::only(PATH, (), operation(), || async {}).open();
    let document = api::document(endpoints.iter().chain([&own]));
    let mut text = serde_json::to_vec_pretty(&document).unwrap_or_default();
    text.push(b'\n');
    let document = Fixed::new("application/json", text.into());
    let answer = move |uri: Uri, headers: HeaderMap| async move { document.answer(&uri, &headers) };
    Endpoint::only(PATH, (), operation(), answer).open()
}

fn operation() -> Operation {
    Operation {
        id: "getOpenapi",
        summary: "This document",
        about: "OpenAPI 3.1. The page /docs shows it.",
        problems: vec![],
        example: PATH.into(),
        ..Operation::new(
            Tag::About,
            api::Answer::file("The document.", "application/json", schemas::object).or_unchanged(),
        )
    }
}
