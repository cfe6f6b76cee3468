//! Answers that are one small JSON document.

use axum::{body::Body, response::Response};
use http::{HeaderValue, header};
use serde::Serialize;

use crate::service::{Error, Fault, encode::Options};

/// Their content type.
pub(super) const JSON: &str = "application/json";

/// A document as an answer.
pub(super) fn json(document: &impl Serialize) -> Result<Response, Error> {
    let mut body = serde_json::to_vec(document)
        .map_err(|_| Error::Internal("a document cannot be written"))?;
    body.push(b'\n');
    let mut response = Response::new(Body::from(body));
    let value = HeaderValue::from_static(JSON);
    response.headers_mut().insert(header::CONTENT_TYPE, value);
    Ok(response)
}

/// Such an answer has no other format.
pub(super) fn no_looks(options: Options) -> Result<(), Error> {
    let mut faults = vec![];
    let mut refuse = |name: &str, value: Option<String>| {
        if let Some(value) = value {
            let detail = "this answer is always JSON with all digits";
            faults.push(Fault::new(name, value, detail, "nothing"));
        }
    };
    refuse(
        "format",
        options.encoding.map(|encoding| encoding.name().into()),
    );
    refuse(
        "decimals",
        options.decimals.map(|decimals| decimals.to_string()),
    );
    refuse("size", options.size.map(|size| size.to_string()));
    if faults.is_empty() {
        Ok(())
    } else {
        Err(Error::Invalid(faults))
    }
}
