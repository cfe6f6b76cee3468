//! The REST door: addresses in, streamed bodies and problems out. It decides nothing itself.

mod negotiate;
mod points;
mod portrait;
mod problem;
mod profiles;

use std::sync::Arc;

use axum::{Router, extract::Request, response::Response, routing::get};
use http::{HeaderValue, Method, Uri, header};

use crate::service::{Error, Service};
use problem::Problem;

/// What there is, for those who look elsewhere.
const PATHS: &str = "/v1/points, /v1/profiles, /v1/profiles/{name}, \
                     /v1/profiles/{name}/spectrum.svg, /livez, /readyz";

/// The routes of the REST door.
pub fn routes(service: Arc<Service>) -> Router {
    Router::new()
        .route("/v1/points", get(points::get))
        .route("/v1/profiles", get(profiles::get))
        .route("/v1/profiles/{name}", get(portrait::get))
        .route("/v1/profiles/{name}/spectrum.svg", get(portrait::svg))
        .with_state(service)
}

/// The answer where nothing is.
#[must_use]
pub fn not_found(request: &Request) -> Response {
    let error = Error::NoSuchPath {
        path: request.uri().path().into(),
        available: PATHS.into(),
    };
    Problem::response(&error)
}

/// The answer to a method that a path does not take. All paths take the same ones.
pub async fn wrong_method(method: Method, uri: Uri) -> Response {
    const ALLOWED: &str = "GET, HEAD";
    let error = Error::NoSuchMethod {
        path: uri.path().into(),
        method: method.to_string(),
        allowed: ALLOWED.into(),
    };
    let mut response = Problem::response(&error);
    let allow = HeaderValue::from_static(ALLOWED);
    response.headers_mut().insert(header::ALLOW, allow);
    response
}
