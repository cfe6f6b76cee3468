//! Exchanges: a request from its head until the socket has taken the last byte of its answer.
//!
//! Two layers see every request of both protocols, also those to open pages and to health.
//! [`observed`] is the outermost one. It names the request, counts it against its client's address,
//! makes its [`Exchange`] and lets the answer leave through it. [`Intake`] is inside of what finishes
//! answers, so that its refusals are finished like all others. It bounds requests at once, bodies and
//! the time to the head of the answer.

mod intake;
mod open;
mod progress;
mod reply;
mod report;

use std::{net::IpAddr, sync::Arc};

use axum::{
    Router,
    body::Body,
    extract::{Request, State},
    middleware::{self, Next},
    response::Response,
};
use http::{HeaderName, HeaderValue, StatusCode, header};
use tracing::Instrument as _;

use super::{Peer, dialect::Dialect, identity::REQUEST_ID, metrics::Metrics, spans::Spans};
pub(super) use intake::Intake;
pub(super) use open::{Fate, OpenExchanges};
use progress::Terms;
use reply::{Exchange, Places};
use report::Report;
pub(super) use report::code as grpc_code;
use strew_access::{Gate, Usage};
use strew_config::{Server, seconds};
use strew_error::{Denied, Error};
use strew_service::{Budget, Record};

/// The state that all exchanges share. Cheap to clone.
#[derive(Clone, Debug)]
pub(super) struct Exchanges {
    pub(super) metrics: Metrics,
    pub(super) spans: Option<Spans>,
    pub(super) gate: Arc<Gate>,
    pub(super) budget: Budget,
    pub(super) terms: Terms,
}

/// The memory of an exchange besides the bytes of its request and its answer: its state, that of HTTP, and
/// headers.
const BASE: usize = 16 << 10;

/// Where a request comes from: its address behind trusted proxies, and what that uses.
#[derive(Clone, Debug)]
pub(super) struct Client {
    pub(super) address: IpAddr,
    pub(super) usage: Arc<Usage>,
}

/// Why the intake should refuse a request.
#[derive(Clone, Debug)]
struct Refused(Error);

/// A health check that is answered whatever else is in progress.
#[derive(Clone, Copy, Debug)]
struct Probe;

/// The paths of health checks and metrics, which have a reserve of places.
const PROBES: [&str; 4] = [
    "/livez",
    "/readyz",
    "/metrics",
    "/grpc.health.v1.Health/Check",
];

const FORWARDED_FOR: HeaderName = HeaderName::from_static("x-forwarded-for");

/// The terms of answers, from the settings.
pub(super) fn terms(server: &Server) -> Terms {
    Terms {
        patience: seconds(server.stalled_reader_seconds),
        rate: server.min_bytes_per_second,
        whole: seconds(server.max_stream_seconds),
    }
}

/// A router whose requests are exchanges.
pub(super) fn observed(router: Router, exchanges: Exchanges) -> Router {
    router.layer(middleware::from_fn_with_state(exchanges, exchange))
}

async fn exchange(
    State(exchanges): State<Exchanges>,
    mut request: Request,
    next: Next,
) -> Response {
    let dialect = Dialect::of(request.headers());
    let client = exchanges.client(&request);
    let usage = client.usage.clone();
    let budget = exchanges.budget.of_address(usage.clone());
    let report = Report::start(exchanges.metrics, exchanges.spans, budget.clone(), &request);
    let (record, span) = (report.record().clone(), report.span().clone());

    let is_probe = PROBES.contains(&request.uri().path());
    let probe = is_probe.then(|| usage.probe()).flatten();
    // Refusals are answers, too: those beyond the limits are small, and beyond twice the limits they
    // have no body that a client could leave untouched.
    let (is_free, used, limit) = (
        probe.is_some(),
        usage.requests.used(),
        usage.requests.limit(),
    );
    let base = match is_free {
        true => Ok(budget.hold_anyway(BASE)),
        false => budget.hold(BASE),
    };
    let refused = match base.as_ref().err() {
        Some(error) => Some(error.clone()),
        None if is_free || used < limit => None,
        None => {
            let what = "requests";
            Some(Denied::Address { what, limit }.into())
        }
    };
    let is_bare = base.is_err() || !is_free && used >= limit.saturating_mul(2);
    let places = Places {
        _request: usage.request(),
        _probe: probe,
        _base: base.unwrap_or_else(|_| budget.hold_anyway(BASE)),
    };
    let open = request.extensions().get::<Arc<OpenExchanges>>();
    let entry = open.map(OpenExchanges::begin);
    let exchange = Exchange::new(report, dialect, exchanges.terms, places, entry);

    let extensions = request.extensions_mut();
    extensions.insert(client);
    if is_free {
        extensions.insert(Probe);
    }
    let mut response = match refused {
        Some(error) if is_bare => record.clone().scope(async { bare(dialect, &error) }).await,
        refused => {
            if let Some(error) = refused {
                request.extensions_mut().insert(Refused(error));
            }
            let answered = next.run(request);
            record.clone().scope(answered).instrument(span).await
        }
    };
    if let Ok(id) = HeaderValue::from_str(record.id()) {
        response.headers_mut().insert(REQUEST_ID, id);
    }
    exchange.answer(response)
}

impl Exchanges {
    fn client(&self, request: &Request) -> Client {
        let lines: Vec<&[u8]> = request
            .headers()
            .get_all(FORWARDED_FOR)
            .iter()
            .map(HeaderValue::as_bytes)
            .collect();
        // Inside a program without sockets all are one.
        let peer = request.extensions().get::<Peer>();
        let peer = peer.map_or(IpAddr::from([0, 0, 0, 0]), |peer| peer.0.ip());
        let address = self.gate.client(peer, lines.into_iter());
        Client {
            usage: self.gate.usage(address),
            address,
        }
    }
}

/// A refusal without a body.
fn bare(dialect: Dialect, error: &Error) -> Response {
    if dialect.is_call() {
        return dialect.refusal(error);
    }
    Record::refuse(error.kind());
    let mut response = Response::new(Body::empty());
    *response.status_mut() = match error {
        Error::Denied(_) => StatusCode::TOO_MANY_REQUESTS,
        _ => StatusCode::SERVICE_UNAVAILABLE,
    };
    let seconds = error.retry_seconds().unwrap_or(1);
    response
        .headers_mut()
        .insert(header::RETRY_AFTER, seconds.into());
    response
}
