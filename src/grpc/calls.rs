//! The services of gRPC on the common port, and where a path leads.

use std::{convert::Infallible, sync::Arc};

use axum::Router;
use strew_service::Service;
use tonic::{Status, body::Body as TonicBody, codec::CompressionEncoding, codegen};
use tower::{Service as _, ServiceBuilder, service_fn};

use super::{
    points::Points,
    server::{METHODS, point_service_server::PointServiceServer},
    unpacked::unpacked,
};
use crate::body::{Body, Request, Response};

/// The name of the service of the contract.
pub(super) const NAME: &str = "strew.v1.PointService";

/// The paths of the services, that of the contract first.
const SERVICES: [&str; 4] = [
    "/strew.v1.PointService/{*method}",
    "/grpc.health.v1.Health/{*method}",
    "/grpc.reflection.v1.ServerReflection/{*method}",
    "/grpc.reflection.v1alpha.ServerReflection/{*method}",
];

/// The route of a path, as metrics and logs name it: a method of the contract, or any of a service.
pub fn route(path: &str) -> Option<&'static str> {
    let is_of = |any: &&str| {
        let method = any.strip_suffix("{*method}");
        let method = method.and_then(|service| path.strip_prefix(service));
        method.is_some_and(|method| !method.is_empty())
    };
    let any = SERVICES.iter().copied().find(is_of)?;
    let known = METHODS.iter().copied().find(|known| *known == path);
    Some(known.unwrap_or(any))
}

/// The answer to a method that does not exist.
pub fn unimplemented() -> Response {
    let methods = METHODS.join(", ");
    Status::unimplemented(format!("unknown method; available: {methods}")).into_http()
}

/// The services of gRPC.
#[derive(Debug)]
pub struct Calls {
    pub contract: Router,
    /// Health and reflection.
    pub others: Router,
}

pub(super) fn contract(service: Arc<Service>) -> Router {
    // A message that comes to it is not longer than its limit, and is not packed.
    let server = PointServiceServer::new(Points(service.clone()))
        .max_decoding_message_size(usize::MAX)
        .send_compressed(CompressionEncoding::Gzip)
        .send_compressed(CompressionEncoding::Zstd);
    let answer = move |request: Request| {
        let (service, mut server) = (service.clone(), server.clone());
        async move {
            match unpacked(&service, request).await {
                Ok(request) => server
                    .call(request)
                    .await
                    .map(|answer| answer.map(Body::new)),
                Err(status) => Ok(status.into_http()),
            }
        }
    };
    Router::new().route_service(SERVICES[0], service_fn(answer))
}

/// A router with a service that the library generates besides.
pub(super) fn routed<S>(router: Router, place: usize, service: S) -> Router
where
    S: codegen::Service<
            http::Request<TonicBody>,
            Response = http::Response<TonicBody>,
            Error = Infallible,
        >,
    S: Clone + Send + Sync + 'static,
    S::Future: Send + 'static,
{
    let service = ServiceBuilder::new()
        .map_request(|request: Request| request.map(TonicBody::new))
        .map_response(|response: http::Response<TonicBody>| response.map(Body::new))
        .service(service);
    router.route_service(SERVICES[place], service)
}
