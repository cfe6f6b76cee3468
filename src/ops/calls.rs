//! gRPC calls on the common port: native ones, those of web pages (gRPC-Web), and requests to their
//! paths that are not calls.

use std::{convert::Infallible, mem::take, pin::pin};

use http::{StatusCode, Version};
use http_body_util::BodyExt as _;
use strew_service::Record;
use tonic_web::GrpcWebLayer;
use tower::{Layer as _, Service as _, service_fn};

use super::{
    dialect::{Dialect, grpc_code},
    exchange::Inbound,
    step::{Next, Step},
};
use crate::{
    body::{Body, Response},
    grpc::{self, Deadline},
    rest,
};

/// Makes calls of web pages calls like others, and ends calls in the time that they allow; if calls are served here.
#[derive(Clone, Copy, Debug)]
pub(super) struct Calls(pub(super) bool);

impl Step<Inbound> for Calls {
    /// Answers a request to the path of a call. What is no call gets a problem document instead of a gRPC status.
    async fn answer(&self, mut inbound: Box<Inbound>, next: &impl Next<Inbound>) -> Response {
        let request = &mut inbound.request;
        let route = match self.0 {
            true => grpc::route(request.uri().path()),
            false => None,
        };
        let Some(route) = route else {
            return next.answer(inbound).await;
        };
        Record::at(route);
        match inbound.client.dialect {
            Dialect::Rest => {
                let allowed = "POST with the content type application/grpc or application/grpc-web";
                rest::not_a_call(request, StatusCode::UNSUPPORTED_MEDIA_TYPE, allowed)
            }
            Dialect::Grpc if request.version() < Version::HTTP_2 => {
                let allowed = "gRPC over HTTP/2, gRPC-Web over any HTTP";
                rest::not_a_call(request, StatusCode::HTTP_VERSION_NOT_SUPPORTED, allowed)
            }
            Dialect::Grpc => in_time(inbound, next).await,
            Dialect::GrpcWeb | Dialect::GrpcWebText => {
                let request = take(request);
                // It has the request answered once it reads like any other, and once.
                let mut inbound = Some(inbound);
                let inner = service_fn(|request: http::Request<tonic::body::Body>| {
                    let inbound = inbound.take();
                    Box::pin(async move {
                        let Some(mut inbound) = inbound else {
                            return Ok::<_, Infallible>(grpc::unimplemented());
                        };
                        inbound.request = request.map(Body::new);
                        Ok(in_time(inbound, next).await)
                    })
                });
                let answer = GrpcWebLayer::new().layer(inner).call(request).await;
                answer.unwrap_or_else(|never| match never {}).map(Body::new)
            }
        }
    }
}

async fn in_time(inbound: Box<Inbound>, next: &impl Next<Inbound>) -> Response {
    let is_of_page = inbound.client.dialect != Dialect::Grpc;
    let mut response = match Deadline::of(inbound.request.headers()) {
        Err(refusal) => refusal.into_http(),
        Ok(None) => next.answer(inbound).await,
        Ok(Some(deadline)) => {
            let answer = pin!(next.answer(inbound));
            let mut response = match deadline.answer(answer).await {
                Ok(response) => response,
                Err(late) => late.into_http(),
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
    if !is_of_page {
        // The exchange sees the trailers.
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
