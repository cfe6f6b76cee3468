//! Exchanges: a request from its head until the socket has taken the last byte of its answer.
//!
//! Two steps see every request of both protocols, also those to open pages and to health.
//! [`Exchanges`] is the outermost one. It names the request, counts it against its client's address,
//! makes its [`Exchange`] and lets the answer leave through it. [`Intake`] is inside of what finishes
//! answers, so that its refusals are finished like all others. It bounds requests at once, bodies and
//! the time to the head of the answer.

mod intake;
mod progress;
mod reply;
mod report;

use std::{
    net::{IpAddr, SocketAddr},
    pin::pin,
    sync::Arc,
};

use http::{HeaderName, HeaderValue, Method, StatusCode, header};
use http_body::Body as _;

use super::{
    dialect::Dialect,
    identity::REQUEST_ID,
    metrics::Metrics,
    spans::Spans,
    step::{Next, Step},
};
use crate::body::{Body, Request, Response};
pub(super) use intake::Intake;
pub(super) use progress::Fate;
use progress::{OpenExchanges, Terms};
use reply::{Exchange, Permits};
use report::Report;
use strew_config::{Server, seconds};
use strew_error::{Denied, Error};
use strew_service::access::{Gate, Usage};
use strew_service::{Budget, Record};
use tokio::time::Instant;

#[derive(Clone, Debug)]
pub(super) struct Exchanges {
    pub(super) metrics: Arc<Metrics>,
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
    /// A health check is answered whatever else is in progress.
    pub(super) is_probe: bool,
    pub(super) dialect: Dialect,
}

/// Where the requests of a connection come from, and the exchanges that are open on it. Cheap to clone.
#[derive(Clone, Debug)]
pub(super) struct From {
    peer: SocketAddr,
    address: IpAddr,
    usage: Arc<Usage>,
    pub(super) open: Arc<OpenExchanges>,
}

/// A request on its way through the steps. On the heap: what waits for an answer then moves it as a pointer.
pub(super) struct Inbound {
    pub(super) request: Request,
    pub(super) client: Client,
    from: From,
    pub(super) refused: Option<Error>,
}

/// The paths of health checks and metrics, which have a reserve of places.
const PROBES: [&str; 4] = [
    "/livez",
    "/readyz",
    "/metrics",
    "/grpc.health.v1.Health/Check",
];

const FORWARDED_FOR: HeaderName = HeaderName::from_static("x-forwarded-for");

pub(super) fn terms(server: &Server) -> Terms {
    Terms {
        patience: seconds(server.stalled_reader_seconds),
        rate: server.min_bytes_per_second,
        whole: seconds(server.max_stream_seconds),
    }
}

impl Exchanges {
    pub(super) fn from(&self, peer: SocketAddr) -> From {
        let address = peer.ip().to_canonical();
        From {
            usage: self.gate.usage(address),
            address,
            open: OpenExchanges::new(),
            peer,
        }
    }

    /// A request, of which the headers name another client than the peer or do not.
    pub(super) fn inbound(&self, from: From, request: Request) -> Box<Inbound> {
        let headers = request.headers();
        let address = match headers.contains_key(FORWARDED_FOR) {
            false => from.address,
            true => {
                let lines = headers.get_all(FORWARDED_FOR).iter();
                let lines = lines.map(HeaderValue::as_bytes);
                self.gate.client(from.address, lines)
            }
        };
        let client = Client {
            usage: match address == from.address {
                true => from.usage.clone(),
                false => self.gate.usage(address),
            },
            address,
            is_probe: false,
            dialect: Dialect::of(headers),
        };
        Box::new(Inbound {
            request,
            client,
            from,
            refused: None,
        })
    }
}

impl Step<Inbound> for Exchanges {
    async fn answer(&self, mut inbound: Box<Inbound>, next: &impl Next<Inbound>) -> Response {
        let (dialect, now) = (inbound.client.dialect, Instant::now());
        let is_head = *inbound.request.method() == Method::HEAD;
        let usage = inbound.client.usage.clone();
        let budget = self.budget.of_address(usage.clone());
        let asked = (dialect.protocol(), inbound.from.peer);
        let reported = (&self.metrics, self.spans.as_ref());
        let report = Report::start(reported, budget.clone(), &inbound.request, asked, now);
        let record = report.record().clone();

        let is_probe = PROBES.contains(&inbound.request.uri().path());
        let probe = is_probe.then(|| usage.probe()).flatten();
        // Refusals are answers, too: those beyond the limits are small, and beyond twice the limits they
        // have no body that a client could leave untouched.
        let is_probe = probe.is_some();
        inbound.client.is_probe = is_probe;
        let (used, limit) = (usage.requests.used(), usage.requests.limit());
        let base = match is_probe {
            true => Ok(budget.hold_anyway(BASE)),
            false => budget.hold(BASE),
        };
        inbound.refused = match base.as_ref().err() {
            Some(error) => Some(error.clone()),
            None if is_probe || used < limit => None,
            None => {
                let what = "requests";
                Some(Denied::Address { what, limit }.into())
            }
        };
        let is_bare = base.is_err() || !is_probe && used >= limit.saturating_mul(2);
        let permits = Permits {
            _request: usage.request(),
            _probe: probe,
            _base: base.unwrap_or_else(|_| budget.hold_anyway(BASE)),
        };
        let open = inbound.from.open.clone();
        let exchange = Exchange::new(report, dialect, self.terms, permits, open, now);

        let answered = pin!(async {
            match inbound.refused.take() {
                Some(error) if is_bare => bare(dialect, &error),
                refused => {
                    inbound.refused = refused;
                    next.answer(inbound).await
                }
            }
        });
        let mut response = record.clone().scope(answered).await;
        if let Ok(mut id) = HeaderValue::from_str(record.id()) {
            // Never indexed in HTTP/2: it is another one in each answer, and would push others out of the table.
            id.set_sensitive(true);
            response.headers_mut().insert(REQUEST_ID, id);
        }
        announce_length(&mut response, is_head);
        exchange.answer(&mut response);
        response
    }
}

/// States the length of an answer that has no body to show it. Of other answers the HTTP library does, and of answers to
/// HEAD the router, which leaves no body.
fn announce_length(response: &mut Response, is_head: bool) {
    if let Some(length) = response.body().size_hint().exact()
        && is_head != (length == 0)
    {
        let slot = response.headers_mut().entry(header::CONTENT_LENGTH);
        slot.or_insert_with(|| length.into());
    }
    if is_head {
        *response.body_mut() = Body::empty();
    }
}

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
