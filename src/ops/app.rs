//! The app: every step of a request, in their order.
//!
//! A connection hands each request to the outermost step. A step does its part, has the next one answer, and may change
//! the answer on its way back. The last one is axum's router of all paths, of REST and of gRPC.

use std::{any::Any, panic::AssertUnwindSafe, sync::Arc};

use axum::Router;
use futures_util::FutureExt as _;
use strew_error::Error;
use strew_service::access::Gate;
use tower::{Service as _, ServiceBuilder};

use super::{
    calls::Calls,
    exchange::{Client, Exchanges, Inbound, Intake},
    gate,
    metrics::Metrics,
    step::{Layered, Next, Step},
};
use crate::{
    body::{Request, Response},
    grpc,
    rest::{Finish, Preferences, Routes},
};

pub(super) type Steps =
    Layered<Exchanges, Layered<Finish, Layered<Panics, Layered<Calls, Layered<Bounds, Router>>>>>;

/// The bounds on requests that are taken on; none for administrators.
type Bounds = Option<Intake>;

/// All steps, from the head of a request to its answer. At the address of administrators there are no calls and no bounds,
/// and everyone is one.
pub(super) fn steps(
    exchanges: Exchanges,
    finish: Finish,
    routes: Routes,
    calls: Option<grpc::Calls>,
    (intake, gate): (Bounds, Option<Arc<Gate>>),
) -> Steps {
    let panics = Panics(exchanges.metrics.clone());
    let has_calls = Calls(calls.is_some());
    let router = router(routes, calls, gate);
    ServiceBuilder::new()
        // Names the request and counts it against its client's address. The answer leaves through it, so that each
        // byte is counted until the socket has it, and there is one report of all: it is outermost.
        .layer(exchanges.layer())
        // Requests for foreign hosts, of foreign pages and with heads too long go no further. All answers, also
        // refusals of the steps below, get what browsers and caches need, and are compressed.
        .layer(finish.layer())
        // A panic below is one request's, and is answered.
        .layer(panics.layer())
        // Calls of web pages become calls as all others, and the deadline of a call begins.
        .layer(has_calls.layer())
        // The number of requests at once, the bytes of their bodies, and the time to the head of an answer.
        .layer(intake.layer())
        .service(router)
}

/// All paths. What is not open to everyone is behind the gate; unknown paths are open.
fn router(routes: Routes, calls: Option<grpc::Calls>, gate: Option<Arc<Gate>>) -> Router {
    let Routes { gated, open, paths } = routes;
    let nothing = async move |request: Request| -> Response {
        let client = request.extensions().get::<Client>();
        match client.is_some_and(|client| client.dialect.is_call()) {
            true => grpc::unimplemented(),
            false => paths.nothing(request.uri().path()),
        }
    };
    let mut open = open.fallback(nothing);
    // A service that is merged into another router is boxed once more; handlers are not.
    let gated = match calls {
        Some(calls) => {
            open = open.merge(calls.others);
            calls.contract.merge(gated)
        }
        None => gated,
    };
    gated.route_layer(gate::layer(gate)).merge(open)
}

impl Step<Inbound> for Finish {
    async fn answer(&self, inbound: Box<Inbound>, next: &impl Next<Inbound>) -> Response {
        let (request, dialect) = (&inbound.request, inbound.client.dialect);
        let misdirected = self.misdirected(request);
        if let (None, Some(allowed)) = (&misdirected, self.preflight(request)) {
            return allowed;
        }
        let preferences = Preferences::of(request);
        let refusal = misdirected.map(|error| dialect.refusal(&error));
        let mut response = match refusal.or_else(|| self.refusal(request)) {
            Some(refusal) => refusal,
            None => next.answer(inbound).await,
        };
        self.finish(&preferences, &mut response).await;
        response
    }
}

/// The router is the last step: from here on the client is among the extensions of the request.
impl Next<Inbound> for Router {
    async fn answer(&self, inbound: Box<Inbound>) -> Response {
        let Inbound {
            mut request,
            client,
            ..
        } = *inbound;
        request.extensions_mut().insert(client);
        let answered = self.clone().call(request).await;
        answered.unwrap_or_else(|never| match never {})
    }
}

#[derive(Clone, Debug)]
pub(super) struct Panics(pub(super) Arc<Metrics>);

impl Step<Inbound> for Panics {
    async fn answer(&self, inbound: Box<Inbound>, next: &impl Next<Inbound>) -> Response {
        let dialect = inbound.client.dialect;
        let answer = AssertUnwindSafe(next.answer(inbound)).catch_unwind().await;
        answer.unwrap_or_else(|panic| {
            self.0.panics.inc();
            tracing::error!(panic = said(&*panic), "a handler panicked");
            let error = Error::Internal("the request could not be answered");
            dialect.refusal(&error)
        })
    }
}

fn said(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no text")
}
