//! gRPC calls on the common port: native ones, those of web pages (gRPC-Web), and requests to their
//! paths that are not calls.

use std::sync::Arc;

use axum::{
    Router,
    body::Body,
    extract::Request,
    middleware::{self, Next},
    response::Response,
};
use http::Version;
use http_body_util::BodyExt as _;
use strew_access::Gate;
use strew_service::Record;
use tonic_web::GrpcWebLayer;

use super::{
    dialect::Dialect,
    exchange::{Intake, grpc_code},
    gate,
};
use crate::{grpc, rest};

/// The routes of gRPC, behind the gate. (The last layer is the first to see a request.)
pub(super) fn routes(grpc: Router, gate: Arc<Gate>, intake: &Intake) -> Router {
    intake
        .before(grpc)
        .layer(middleware::from_fn_with_state(gate, gate::of_calls))
        .layer(middleware::from_fn(on_terms))
        .layer(GrpcWebLayer::new())
        .layer(middleware::from_fn(only_calls))
}

/// Rejects requests that are not calls with a problem document instead of a gRPC status.
async fn only_calls(request: Request, next: Next) -> Response {
    match Dialect::of(request.headers()) {
        Dialect::Rest => rest::not_a_call(&request),
        Dialect::Grpc if request.version() < Version::HTTP_2 => rest::needs_http2(&request),
        _ => next.run(request).await,
    }
}

/// Calls are answered as compressed as they ask, and in time.
async fn on_terms(mut request: Request, next: Next) -> Response {
    let mut response = match grpc::terms(request.headers_mut()) {
        Err(refusal) => refusal.into_http::<Body>(),
        Ok(None) => next.run(request).await,
        Ok(Some(deadline)) => {
            let mut response = match deadline.answer(next.run(request)).await {
                Ok(response) => response,
                Err(late) => late.into_http::<Body>(),
            };
            // The exchange ends with it, also after the head.
            response.extensions_mut().insert(deadline);
            response
        }
    };
    grpc::improve(response.headers_mut());
    let Some(record) = Record::current() else {
        return response;
    };
    if let Some(code) = grpc_code(response.headers()) {
        record.ended(code);
        return response;
    }
    // Noted here, because the body of a web page's call has its trailers in data.
    response.map(|body| {
        Body::new(body.map_frame(move |frame| {
            if let Some(code) = frame.trailers_ref().and_then(grpc_code) {
                record.ended(code);
            }
            frame
        }))
    })
}
