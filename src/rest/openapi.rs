//! `GET /openapi.json`: the description of the REST API, for programs.

use axum::extract::State;
use bytes::Bytes;

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    context::Context,
    document::JSON,
    fixed::Fixed,
    problem::Refused,
};
use crate::body::Response;

const PATH: &str = "/openapi.json";

/// The path, with the description of these endpoints and itself.
pub(super) fn endpoint(endpoints: &[Endpoint]) -> Endpoint {
    let with = |document: Fixed| Endpoint::only(PATH, document, operation(), answer).open();
    let own = with(Fixed::new(JSON, Bytes::new()));
    let document = api::document(endpoints.iter().chain([&own]));
    let mut text = serde_json::to_vec_pretty(&document).unwrap_or_default();
    text.push(b'\n');
    with(Fixed::new(JSON, text.into()))
}

async fn answer(State(document): State<Fixed>, context: Context) -> Result<Response, Refused> {
    Ok(document.answer(&context.uri, &context.headers))
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
            api::Answer::file("The document.", JSON, schemas::object).or_unchanged(),
        )
    }
}
