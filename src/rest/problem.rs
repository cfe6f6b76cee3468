//! Errors as problem documents (RFC 9457), also those of unknown paths and of methods that a path does not take.

use std::sync::Arc;

use axum::{body::to_bytes, response::IntoResponse};
use http::{HeaderValue, Method, StatusCode, Uri, header};
use schemars::JsonSchema;
use serde::Serialize;
use strew_error::{Denied, Error, Fault, Kind, Short, integer::Long};
use strew_service::Record;

use crate::body::{Body, Response};

/// Why there is no answer (RFC 9457).
#[derive(Default, Debug, Serialize, JsonSchema)]
pub(super) struct Problem<'a> {
    /// The type of the problem.
    #[schemars(extend("enum" = types()))]
    r#type: String,
    /// The title, the same for all problems of a type.
    title: &'a str,
    /// The status of the response.
    #[schemars(range(min = 400, max = 599))]
    status: u16,
    /// The fault in words.
    detail: String,
    /// The faults of an invalid query.
    #[serde(skip_serializing_if = "<[Fault]>::is_empty")]
    #[schemars(default)]
    errors: &'a [Fault],
    /// The exact number of points, if there are too many.
    #[serde(skip_serializing_if = "Option::is_none")]
    count: Option<Long<u128>>,
    /// The limit that was exceeded.
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<Long<u64>>,
    /// The digest of the table that the query pins, if another one would answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pinned: Option<&'a str>,
    /// The digest of the table that would answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    loaded: Option<&'a str>,
    #[serde(flatten)]
    rate: Option<Rate>,
    /// The id of the request in the server's log; also the header x-request-id of every answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    request_id: Option<String>,
}

/// The state of a rate limit that was exceeded.
#[derive(Debug, Serialize, JsonSchema)]
struct Rate {
    /// The number of points that were requested.
    points: Long<u128>,
    /// The number that is left now.
    left: Long<u64>,
    /// The number that is added each second.
    points_per_second: f64,
    /// The greatest number there can be.
    burst_points: f64,
    /// The time after which the request is worth another try.
    retry_after_seconds: f64,
}

impl Rate {
    fn new(points: u128, short: &Short) -> Self {
        Self {
            points: Long(points),
            left: Long(short.level.left),
            points_per_second: short.level.rate.points_per_second,
            burst_points: short.level.rate.burst_points,
            retry_after_seconds: short.wait.as_secs_f64(),
        }
    }
}

pub(super) fn urn(kind: Kind) -> String {
    format!("urn:strew:problem:{}", kind.slug())
}

/// Every problem type, and that of errors that a library makes.
fn types() -> Vec<String> {
    let types = Kind::ALL.into_iter().map(urn);
    types.chain(["about:blank".into()]).collect()
}

fn request_id() -> Option<String> {
    Record::current().map(|record| record.id().to_owned())
}

impl<'a> Problem<'a> {
    fn new(error: &'a Error) -> Self {
        let wire = error.kind().wire();
        let count = match error {
            Error::TooManyPoints { count, .. } => Some(Long(*count)),
            _ => None,
        };
        let rate = match error {
            Error::Denied(Denied::TooFast { points, short }) => Some(Rate::new(*points, short)),
            _ => None,
        };
        Self {
            r#type: urn(error.kind()),
            title: wire.title,
            status: wire.status,
            detail: error.to_string(),
            errors: error.faults(),
            count,
            limit: error.limit().map(Long),
            pinned: error.digests().map(|(pinned, _)| pinned),
            loaded: error.digests().map(|(_, loaded)| loaded),
            rate,
            request_id: request_id(),
        }
    }

    pub(super) fn response(error: &'a Error) -> Response {
        Record::refuse(error.kind());
        let mut response = Self::new(error).into_response();
        let headers = response.headers_mut();
        if let Some(seconds) = error.retry_seconds() {
            headers.insert(header::RETRY_AFTER, seconds.into());
        }
        if let Error::UnknownCoding { .. } = error {
            // RFC 9110, 12.5.3: what is read.
            headers.insert(header::ACCEPT_ENCODING, HeaderValue::from_static("gzip"));
        }
        // RFC 6750, 3: only clients that sent a key learn that it is wrong.
        let challenge = match error {
            Error::Denied(Denied::NoKey) => "Bearer realm=\"strew\"",
            Error::Denied(Denied::WrongKey) => "Bearer realm=\"strew\", error=\"invalid_token\"",
            _ => return response,
        };
        let challenge = HeaderValue::from_static(challenge);
        headers.insert(header::WWW_AUTHENTICATE, challenge);
        response
    }

    /// An error that is nothing but a status of HTTP.
    pub(super) fn of_status(status: StatusCode, detail: String) -> Response {
        let problem = Problem {
            r#type: "about:blank".into(),
            title: status.canonical_reason().unwrap_or("An error"),
            status: status.as_u16(),
            detail,
            request_id: request_id(),
            ..Problem::default()
        };
        problem.into_response()
    }

    fn into_response(self) -> Response {
        let mut body = serde_json::to_vec(&self).unwrap_or_default();
        body.push(b'\n');
        let mut response = Response::new(Body::from(body));
        let status = StatusCode::from_u16(self.status);
        *response.status_mut() = status.unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        let headers = response.headers_mut();
        let content_type = HeaderValue::from_static("application/problem+json");
        headers.insert(header::CONTENT_TYPE, content_type);
        response
    }
}

/// An error as the bytes of a whole HTTP/1.1 response, after which the connection closes: for clients whose request is
/// not read.
pub fn last_words(error: &Error) -> Vec<u8> {
    let problem = Problem::new(error);
    let body = serde_json::to_string(&problem).unwrap_or_default();
    let status = StatusCode::from_u16(problem.status).unwrap_or_default();
    let (length, reason) = (body.len() + 1, status.canonical_reason());
    let head = format!(
        "HTTP/1.1 {} {}\r\ncontent-type: application/problem+json\r\ncontent-length: {length}\r\n\
         cache-control: no-store\r\nretry-after: {}\r\nconnection: close\r\n\r\n{body}\n",
        problem.status,
        reason.unwrap_or_default(),
        error.retry_seconds().unwrap_or(1)
    );
    head.into_bytes()
}

/// The most text of a bare error that is passed on.
const MOST_TEXT: usize = 1000;

/// Whether an answer is an error that a library made, such as to a path that is not UTF-8.
pub(super) fn is_bare(response: &Response) -> bool {
    let status = response.status();
    if !(status.is_client_error() || status.is_server_error()) {
        return false;
    }
    let content_type = response.headers().get(header::CONTENT_TYPE);
    content_type.is_none_or(|of| of.as_bytes().starts_with(b"text/plain"))
}

pub(super) async fn instead(response: Response) -> Response {
    let status = response.status();
    let (parts, body) = response.into_parts();
    let text = to_bytes(body, MOST_TEXT).await.unwrap_or_default();
    let detail = match String::from_utf8_lossy(&text) {
        text if text.trim().is_empty() => "the request cannot be answered".into(),
        text => text.trim().to_owned(),
    };
    let mut problem = Problem::of_status(status, detail);
    for (name, value) in &parts.headers {
        if *name != header::CONTENT_TYPE && *name != header::CONTENT_LENGTH {
            problem.headers_mut().append(name.clone(), value.clone());
        }
    }
    problem
}

/// An error on its way to the client, as a problem.
pub struct Refused(pub Error);

impl Refused {
    pub fn response(&self) -> Response {
        Problem::response(&self.0)
    }
}

impl<E: Into<Error>> From<E> for Refused {
    fn from(error: E) -> Self {
        Self(error.into())
    }
}

impl IntoResponse for Refused {
    fn into_response(self) -> Response {
        self.response()
    }
}

/// The most paths that an answer names.
const MOST: usize = 3;
/// The least likeness to a path that is worth naming.
const LIKE: f64 = 0.5;
/// The length to which a longer path is cut before it is compared.
const COMPARED: usize = 80;

/// The paths that are described, with commas between them.
#[derive(Clone, Debug)]
pub struct Paths(pub(super) Arc<str>);

impl Paths {
    /// The answer to an unknown path: those that are most like it.
    pub fn nothing(&self, path: &str) -> Response {
        let available = available(path, &self.0);
        let path = path.into();
        Problem::response(&Error::NoSuchPath { path, available })
    }
}

fn available(path: &str, paths: &str) -> String {
    // The usual mistake is a trailing slash.
    let without = path.trim_end_matches('/');
    let is_known = |wanted: &str| paths.split(", ").any(|known| known == wanted);
    if !without.is_empty() && without != path && is_known(without) {
        return format!("{without} (without the slash at the end)");
    }
    let start: String = path.chars().take(COMPARED).collect();
    let likeness = |known| strsim::normalized_damerau_levenshtein(&start, known);
    let scored = paths.split(", ").map(|known| (likeness(known), known));
    let mut like: Vec<(f64, &str)> = scored.filter(|(likeness, _)| *likeness > LIKE).collect();
    like.sort_by(|a, b| b.0.total_cmp(&a.0));
    let nearest = like.iter().take(MOST).map(|(_, known)| *known);
    let all = is_known("/openapi.json").then_some("all that /openapi.json lists");
    nearest.chain(all).collect::<Vec<_>>().join(", ")
}

pub(super) fn wrong_method(method: &Method, uri: &Uri, allowed: &str) -> Response {
    let path = uri.path();
    let is_query = path == "/v1/points" && method == Method::POST;
    let elsewhere = if is_query {
        "; POST is for /v1/points:query"
    } else {
        ""
    };
    let error = Error::NoSuchMethod {
        path: path.into(),
        method: method.to_string(),
        allowed: format!("{allowed}{elsewhere}"),
    };
    let mut response = Problem::response(&error);
    if let Ok(allow) = HeaderValue::from_str(allowed) {
        response.headers_mut().insert(header::ALLOW, allow);
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paths_most_like_an_unknown_one_are_named() {
        const PATHS: &str = "/v1/points, /v1/points/{id}, /v1/count, /docs, /openapi.json";
        for (path, expected) in [
            ("/v1/points/", "/v1/points (without the slash at the end)"),
            (
                "/v1/point",
                "/v1/points, /v1/count, /v1/points/{id}, all that /openapi.json lists",
            ),
            ("/doc", "/docs, all that /openapi.json lists"),
            ("/wp-login.php", "all that /openapi.json lists"),
        ] {
            assert_eq!(available(path, PATHS), expected, "{path}");
        }
    }
}
