//! gRPC calls on the common port: native ones, those of web pages (gRPC-Web), and what is none.

use std::sync::Arc;

use axum::{
    Router,
    body::Body,
    extract::Request,
    middleware::{self, Next},
    response::Response,
};
use http::{HeaderMap, Version, header};
use tonic_web::GrpcWebLayer;

use super::{
    gate,
    load::{Load, Words},
    observe,
};
use crate::{access::Gate, grpc, rest};

/// The routes of gRPC, for all who can call them and are let in. (The last layer is the first to see a
/// request.)
pub(super) fn routes(grpc: Router, gate: Arc<Gate>, load: &Load) -> Router {
    let words = Words {
        refusal: |error| grpc::refusal(error).map(Body::new),
        broken: |error| grpc::broken(&error).into(),
        ending: |why| Some(Ok(grpc::ending(why)?)),
    };
    load.before(grpc, words)
        .layer(middleware::from_fn_with_state(gate, gate::of_calls))
        .layer(middleware::from_fn(on_terms))
        .layer(GrpcWebLayer::new())
        .layer(middleware::from_fn(only_calls))
}

/// Whether a request is a call, by its content type.
pub(super) fn is_grpc(headers: &HeaderMap) -> bool {
    starts_with(headers, b"application/grpc")
}

fn starts_with(headers: &HeaderMap, start: &[u8]) -> bool {
    let content_type = headers.get(header::CONTENT_TYPE);
    content_type.is_some_and(|value| value.as_bytes().starts_with(start))
}

/// What is no call hears so in the language of those who ask so.
async fn only_calls(request: Request, next: Next) -> Response {
    let headers = request.headers();
    if !is_grpc(headers) {
        return rest::not_a_call(&request);
    }
    let is_web = starts_with(headers, b"application/grpc-web");
    if !is_web && request.version() < Version::HTTP_2 {
        return rest::needs_http2(&request);
    }
    next.run(request).await
}

/// Calls are answered as compressed as they ask, and in time.
async fn on_terms(mut request: Request, next: Next) -> Response {
    let answered = match grpc::terms(request.headers_mut()) {
        Err(refusal) => refusal.into_http::<Body>(),
        Ok(None) => next.run(request).await,
        Ok(Some(deadline)) => deadline.answer(next.run(request)).await.map(Body::new),
    };
    observe::coded(answered)
}
