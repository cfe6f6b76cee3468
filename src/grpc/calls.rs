//! The services of gRPC on the common port, and which one a path belongs to.

use std::{convert::Infallible, fmt, future::ready, sync::Arc};

use tonic::{body::Body as TonicBody, codegen::Service};

use super::methods::{METHODS, unimplemented};
use crate::body::{Answering, Body, Request};

type Answers = Arc<dyn Fn(Request) -> Answering + Send + Sync>;

/// The paths of the services, in the order of [`Calls`]; what follows is a method.
const SERVICES: [(&str, &str); 4] = [
    (
        "/strew.v1.PointService/",
        "/strew.v1.PointService/{*method}",
    ),
    (
        "/grpc.health.v1.Health/",
        "/grpc.health.v1.Health/{*method}",
    ),
    (
        "/grpc.reflection.v1.ServerReflection/",
        "/grpc.reflection.v1.ServerReflection/{*method}",
    ),
    (
        "/grpc.reflection.v1alpha.ServerReflection/",
        "/grpc.reflection.v1alpha.ServerReflection/{*method}",
    ),
];

/// The place of the service that a path belongs to.
fn service(path: &str) -> Option<usize> {
    let is_of = |(prefix, _): &(&str, &str)| path.len() > prefix.len() && path.starts_with(prefix);
    SERVICES.iter().position(is_of)
}

/// The route of a path, if it belongs to a service: a method of the contract, or any of the service.
#[must_use]
pub fn route(path: &str) -> Option<&'static str> {
    let (_, any) = SERVICES[service(path)?];
    let method = METHODS.into_iter().find(|&method| method == path);
    Some(method.unwrap_or(any))
}

/// The services of gRPC. Cheap to clone.
#[derive(Clone)]
pub struct Calls(Arc<[Answers; SERVICES.len()]>);

impl fmt::Debug for Calls {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Calls")
    }
}

impl Calls {
    pub(super) fn new(services: [Answers; SERVICES.len()]) -> Self {
        Self(Arc::new(services))
    }

    /// Answers a request to a path that has a [`route`].
    #[must_use]
    pub fn answer(&self, request: Request) -> Answering {
        match service(request.uri().path()) {
            Some(place) => self.0[place](request),
            None => Box::pin(ready(unimplemented().map(Body::new))),
        }
    }
}

/// A service that the library generates, as it is called here.
pub(super) fn answering<S>(service: S) -> Answers
where
    S: Service<http::Request<TonicBody>, Response = http::Response<TonicBody>, Error = Infallible>,
    S: Clone + Send + Sync + 'static,
    S::Future: Send,
{
    Arc::new(move |request: Request| {
        // Generated services are always ready.
        let mut service = service.clone();
        Box::pin(async move {
            let answered = service.call(request.map(TonicBody::new)).await;
            answered
                .unwrap_or_else(|never| match never {})
                .map(Body::new)
        })
    })
}
