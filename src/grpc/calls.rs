//! The services of gRPC on the common port, and where a path leads.

use std::{convert::Infallible, fmt, future::ready, sync::Arc};

use strew_access::Caller;
use strew_service::Service;
use tonic::{body::Body as TonicBody, codegen};

use super::methods::{METHODS, Method, unimplemented};
use crate::body::{Answering, Body, Request};

type Answers = Arc<dyn Fn(Request) -> Answering + Send + Sync>;

/// The name of the service of the contract.
pub(super) const NAME: &str = "strew.v1.PointService";

/// The paths of the services, that of the contract first, the others in the order of [`Calls`]; what follows is a method.
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

/// Where the path of a call leads.
#[derive(Clone, Copy, Debug)]
pub struct Route {
    /// As metrics and logs name it: a method of the contract, or any of a service.
    pub name: &'static str,
    to: To,
}

#[derive(Clone, Copy, Debug)]
enum To {
    Method(&'static Method),
    /// A method that the contract does not have.
    Unknown,
    /// Another service, by its place.
    Other(usize),
}

/// The route of a path, if it belongs to a service.
#[must_use]
pub fn route(path: &str) -> Option<Route> {
    let is_of = |(prefix, _): &(&str, &str)| path.len() > prefix.len() && path.starts_with(prefix);
    let service = SERVICES.iter().position(is_of)?;
    let any = SERVICES[service].1;
    let method = || METHODS.iter().find(|method| method.path == path);
    let (name, to) = match service.checked_sub(1) {
        Some(other) => (any, To::Other(other)),
        None => method().map_or((any, To::Unknown), |method| {
            (method.path, To::Method(method))
        }),
    };
    Some(Route { name, to })
}

/// The services of gRPC. Cheap to clone.
#[derive(Clone)]
pub struct Calls {
    pub(super) service: Arc<Service>,
    /// All but that of the contract.
    pub(super) others: Arc<[Answers; SERVICES.len() - 1]>,
}

impl fmt::Debug for Calls {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Calls")
    }
}

impl Calls {
    /// Answers a request of a caller.
    #[must_use]
    pub fn answer(&self, route: Route, caller: Caller, request: Request) -> Answering {
        match route.to {
            To::Method(method) => Box::pin(method.answer(self.service.clone(), caller, request)),
            To::Unknown => Box::pin(ready(unimplemented())),
            To::Other(service) => self.others[service](request),
        }
    }
}

/// A service that the library generates, as it is called here.
pub(super) fn answering<S>(service: S) -> Answers
where
    S: codegen::Service<
            http::Request<TonicBody>,
            Response = http::Response<TonicBody>,
            Error = Infallible,
        >,
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
