//! Answers that are one small document: JSON, or a file of another type.

use http::{HeaderValue, header};
use serde::Serialize;
use strew_error::Error;

use crate::body::{Body, Response};

/// The content type of JSON.
pub const JSON: &str = "application/json";

/// A document as an answer.
pub fn json(document: &impl Serialize) -> Result<Response, Error> {
    Ok(file(written(document)?, JSON))
}

/// The bytes of a document: one line.
pub(super) fn written(document: &impl Serialize) -> Result<Vec<u8>, Error> {
    let mut body = serde_json::to_vec(document)
        .map_err(|_| Error::Internal("a document cannot be written"))?;
    body.push(b'\n');
    Ok(body)
}

/// An answer that is true for a moment only, and never kept.
pub fn momentary(mut response: Response) -> Response {
    let value = HeaderValue::from_static("no-store");
    response.headers_mut().insert(header::CACHE_CONTROL, value);
    response
}

/// A file as an answer.
pub fn file(bytes: impl Into<Body>, content_type: &'static str) -> Response {
    let mut response = Response::new(bytes.into());
    // With what is put onto it later there are a dozen: a map that grows is filled anew.
    response.headers_mut().reserve(16);
    let value = HeaderValue::from_static(content_type);
    response.headers_mut().insert(header::CONTENT_TYPE, value);
    response
}
