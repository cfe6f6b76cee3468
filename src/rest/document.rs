//! Answers that are one small JSON document.

use axum::{body::Body, response::Response};
use http::{HeaderValue, header};
use serde::Serialize;

use crate::service::Error;

/// Their content type.
pub(super) const JSON: &str = "application/json";

/// A document as an answer.
pub fn json(document: &impl Serialize) -> Result<Response, Error> {
    let mut body = serde_json::to_vec(document)
        .map_err(|_| Error::Internal("a document cannot be written"))?;
    body.push(b'\n');
    let mut response = Response::new(Body::from(body));
    let value = HeaderValue::from_static(JSON);
    response.headers_mut().insert(header::CONTENT_TYPE, value);
    Ok(response)
}
