//! The REST door: addresses in, streamed bodies and problems out. It decides nothing itself.

mod answer;
pub mod api;
mod body;
mod chunks;
mod coding;
mod context;
mod cors;
mod count;
mod docs;
mod document;
mod finish;
mod freshness;
mod harden;
mod negotiate;
mod openapi;
mod page;
mod points;
mod portrait;
mod problem;
mod profiles;
mod query;
mod single;
mod split;

use std::sync::Arc;

use axum::{Router, extract::Request, response::Response};
use http::StatusCode;

use crate::service::{Error, Service};
use api::Endpoint;
pub use finish::{Settings, finished};
use problem::Problem;

/// What the REST door answers, without what is said about it.
pub fn endpoints(service: &Arc<Service>) -> Vec<Endpoint> {
    vec![
        points::endpoint(service.clone()),
        query::endpoint(service.clone()),
        chunks::endpoint(service.clone()),
        count::endpoint(service.clone()),
        split::endpoint(service.clone()),
        single::by_id(service.clone()),
        single::nearest(service.clone()),
        profiles::endpoint(service.clone()),
        portrait::endpoint(service.clone()),
        portrait::picture(service.clone()),
    ]
}

/// All that the port answers by REST, and what is said about it.
#[derive(Debug)]
pub struct Door {
    /// The routes.
    pub router: Router,
    /// The paths there are, for those who look elsewhere.
    pub paths: String,
}

impl Door {
    /// A door of these endpoints and their description. All but the open ones are put behind a
    /// gate.
    #[must_use]
    pub fn new(mut endpoints: Vec<Endpoint>, gate: impl FnOnce(Router) -> Router) -> Self {
        endpoints.extend(page::endpoints());
        endpoints.extend(docs::endpoints());
        endpoints.push(openapi::endpoint(&endpoints));
        let paths: Vec<&str> = endpoints.iter().map(Endpoint::path).collect();
        let paths = paths.join(", ");
        let (open, closed): (Vec<_>, Vec<_>) = endpoints.into_iter().partition(Endpoint::is_open);
        let joined = |endpoints: Vec<Endpoint>| {
            let routers = endpoints.into_iter().map(Endpoint::into_router);
            routers.fold(Router::new(), Router::merge)
        };
        let router = joined(open).merge(gate(joined(closed)));
        Self { router, paths }
    }
}

/// The answer where nothing is.
#[must_use]
pub fn not_found(request: &Request, paths: &str) -> Response {
    let error = Error::NoSuchPath {
        path: request.uri().path().into(),
        available: paths.into(),
    };
    Problem::response(&error)
}

/// What a client hears, as bytes, for whose connection there is no place.
#[must_use]
pub fn no_place(limit: usize) -> Vec<u8> {
    Problem::last_words(&Error::TooManyConnections { limit })
}

/// The answer to what asks for a gRPC method, but not as a call.
#[must_use]
pub fn not_a_call(request: &Request) -> Response {
    let detail = format!(
        "`{}` is a gRPC method; allowed: POST with the content type application/grpc or \
         application/grpc-web",
        request.uri().path()
    );
    Problem::of_status(StatusCode::UNSUPPORTED_MEDIA_TYPE, detail)
}

/// The answer to a gRPC call over an HTTP that cannot carry it.
#[must_use]
pub fn needs_http2(request: &Request) -> Response {
    let detail = format!(
        "`{}` is a gRPC method; allowed: gRPC over HTTP/2, gRPC-Web over any HTTP",
        request.uri().path()
    );
    Problem::of_status(StatusCode::HTTP_VERSION_NOT_SUPPORTED, detail)
}
