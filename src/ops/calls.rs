//! gRPC calls on the common port: native ones, those of web pages (gRPC-Web), and requests to their
//! paths that are not calls.

use std::{
    convert::Infallible,
    pin::{Pin, pin},
    task::{Context, Poll},
};

use http::Version;
use http_body_util::BodyExt as _;
use strew_service::Record;
use tonic_web::GrpcWebLayer;
use tower::{Layer as _, Service};

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
            Dialect::Rest => rest::not_a_call(request),
            Dialect::Grpc if request.version() < Version::HTTP_2 => rest::needs_http2(request),
            Dialect::Grpc => in_time(inbound, next).await,
            Dialect::GrpcWeb | Dialect::GrpcWebText => {
                let request = std::mem::take(request);
                let inner = OfPage {
                    next,
                    inbound: Some(inbound),
                };
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

/// The inside of a call of a web page, once it reads like any other.
struct OfPage<'a, N> {
    next: &'a N,
    /// All of the request but itself: there is one.
    inbound: Option<Box<Inbound>>,
}

impl<'a, N: Next<Inbound>> Service<http::Request<tonic::body::Body>> for OfPage<'a, N> {
    type Response = Response;
    type Error = Infallible;
    type Future = Pin<Box<dyn Future<Output = Result<Response, Infallible>> + Send + 'a>>;

    fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        Poll::Ready(Ok(()))
    }

    fn call(&mut self, request: http::Request<tonic::body::Body>) -> Self::Future {
        let (next, inbound) = (self.next, self.inbound.take());
        Box::pin(async move {
            let Some(mut inbound) = inbound else {
                return Ok(grpc::unimplemented());
            };
            inbound.request = request.map(Body::new);
            Ok(in_time(inbound, next).await)
        })
    }
}
