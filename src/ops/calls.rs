//! gRPC calls on the common port: native ones, those of web pages (gRPC-Web), and requests to their
//! paths that are not calls.

use std::{
    convert::Infallible,
    pin::{Pin, pin},
    sync::Arc,
    task::{Context, Poll},
};

use http::Version;
use http_body_util::BodyExt as _;
use parking_lot::Mutex;
use strew_access::Gate;
use strew_service::Record;
use tonic::codegen::Service;
use tonic_web::GrpcWebLayer;
use tower_layer::Layer as _;

use super::{
    dialect::{Dialect, grpc_code},
    exchange::{Intake, Visit},
    gate,
};
use crate::{
    body::{Body, Response},
    grpc::{self, Deadline, Route},
    rest,
};

/// The calls of gRPC, behind the gate. Cheap to clone.
#[derive(Clone, Debug)]
pub(super) struct Calls {
    pub(super) calls: grpc::Calls,
    pub(super) gate: Arc<Gate>,
    pub(super) intake: Intake,
}

impl Calls {
    /// Answers a request to the path of a call. What is no call gets a problem document instead of a gRPC status.
    pub(super) async fn answer(&self, route: Route, mut visit: Box<Visit>) -> Response {
        let request = &mut visit.request;
        match visit.dialect {
            Dialect::Rest => rest::not_a_call(request),
            Dialect::Grpc if request.version() < Version::HTTP_2 => rest::needs_http2(request),
            Dialect::Grpc => self.in_time(route, visit).await,
            Dialect::GrpcWeb | Dialect::GrpcWebText => {
                let request = std::mem::take(request);
                let inner = OfPage {
                    calls: self.clone(),
                    route,
                    visit: Arc::new(Mutex::new(Some(visit))),
                };
                let answer = GrpcWebLayer::new().layer(inner).call(request).await;
                answer.unwrap_or_else(|never| match never {}).map(Body::new)
            }
        }
    }

    /// Answers a call in the time that it allows.
    async fn in_time(&self, route: Route, visit: Box<Visit>) -> Response {
        let is_of_page = visit.dialect != Dialect::Grpc;
        let mut response = match Deadline::of(visit.request.headers()) {
            Err(refusal) => refusal.into_http(),
            Ok(None) => self.admitted(route, visit).await,
            Ok(Some(deadline)) => {
                let answer = pin!(self.admitted(route, visit));
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

    async fn admitted(&self, route: Route, visit: Box<Visit>) -> Response {
        let caller = match gate::of_calls(&self.gate, &visit) {
            Ok(caller) => caller,
            Err(denied) => return grpc::refusal(&denied.into()),
        };
        let answer = |request| self.calls.answer(route, caller, request);
        self.intake.answer(visit, answer).await
    }
}

/// The inside of a call of a web page, once it reads like any other.
#[derive(Clone)]
struct OfPage {
    calls: Calls,
    route: Route,
    /// All of the request but itself: there is one.
    visit: Arc<Mutex<Option<Box<Visit>>>>,
}

impl Service<http::Request<tonic::body::Body>> for OfPage {
    type Response = Response;
    type Error = Infallible;
    type Future = Pin<Box<dyn Future<Output = Result<Response, Infallible>> + Send>>;

    fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        Poll::Ready(Ok(()))
    }

    fn call(&mut self, request: http::Request<tonic::body::Body>) -> Self::Future {
        let Self {
            calls,
            route,
            visit,
        } = self.clone();
        Box::pin(async move {
            let Some(mut visit) = visit.lock().take() else {
                return Ok(grpc::unimplemented());
            };
            visit.request = request.map(Body::new);
            Ok(calls.in_time(route, visit).await)
        })
    }
}
