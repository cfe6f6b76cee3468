//! Errors as problem documents (RFC 9457).

use axum::{
    body::Body,
    response::{IntoResponse, Response},
};
use http::{HeaderValue, header};
use serde::Serialize;

use crate::{
    error_map,
    service::{Error, Fault, Kind},
};

/// How long a client should wait before it asks a busy server again, in seconds.
const RETRY_AFTER: &str = "1";

/// The document.
#[derive(Debug, Serialize)]
pub(super) struct Problem<'a> {
    r#type: String,
    title: &'static str,
    status: u16,
    detail: String,
    #[serde(skip_serializing_if = "<[Fault]>::is_empty")]
    errors: &'a [Fault],
    #[serde(skip_serializing_if = "Option::is_none")]
    count: Option<u128>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<u64>,
}

impl<'a> Problem<'a> {
    fn new(error: &'a Error) -> Self {
        let mapped = error_map::http(error.kind());
        let (count, limit) = match error {
            Error::TooManyPoints { count, limit } => (Some(*count), Some(*limit)),
            Error::Busy { limit } => (None, u64::try_from(*limit).ok()),
            _ => (None, None),
        };
        Self {
            r#type: error_map::urn(error.kind()),
            title: mapped.title,
            status: mapped.status.as_u16(),
            detail: error.to_string(),
            errors: error.faults(),
            count,
            limit,
        }
    }

    /// An error as a whole response.
    pub(super) fn response(error: &'a Error) -> Response {
        let mut body = serde_json::to_vec(&Self::new(error)).unwrap_or_default();
        body.push(b'\n');
        let mut response = Response::new(Body::from(body));
        *response.status_mut() = error_map::http(error.kind()).status;
        let headers = response.headers_mut();
        headers.insert(
            header::CONTENT_TYPE,
            HeaderValue::from_static("application/problem+json"),
        );
        if matches!(error.kind(), Kind::Busy | Kind::ShuttingDown) {
            headers.insert(header::RETRY_AFTER, HeaderValue::from_static(RETRY_AFTER));
        }
        response
    }
}

impl IntoResponse for Error {
    fn into_response(self) -> Response {
        Problem::response(&self)
    }
}
