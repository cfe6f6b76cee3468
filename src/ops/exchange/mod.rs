//! Exchanges: a request from its head until the socket has taken the last byte of its answer.
//!
//! Two steps see every request of both protocols, also those to open pages and to health.
//! [`Exchanges`] is the outermost one. It names the request, counts it against its client's address,
//! makes its [`Exchange`] and lets the answer leave through it. [`Intake`] is inside of what finishes
//! answers, so that its refusals are finished like all others. It bounds requests at once, bodies and
//! the time to the head of the answer.

mod intake;
mod open;
mod progress;
mod reply;
mod report;

use std::{net::IpAddr, pin::pin, sync::Arc};

use http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};

use super::{
    dialect::Dialect, heard::Heard, identity::REQUEST_ID, metrics::Metrics, peer::Peer,
    spans::Spans,
};
use crate::body::{Body, Request, Response};
pub(super) use intake::Intake;
pub(super) use open::Fate;
use open::OpenExchanges;
use progress::Terms;
use reply::{Exchange, Places};
use report::{Asked, Report};
use strew_access::{Gate, Usage};
use strew_config::{Server, seconds};
use strew_error::{Denied, Error};
use strew_service::{Budget, Record};
use tokio::time::Instant;

/// The state that all exchanges share. Cheap to clone.
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
}

/// Where the requests of a connection come from, and the exchanges that are open on it. Cheap to clone.
#[derive(Clone, Debug)]
pub(super) struct From {
    pub(super) peer: Peer,
    /// The address of the other end, and what that uses.
    address: IpAddr,
    usage: Arc<Usage>,
    pub(super) open: Arc<OpenExchanges>,
}

/// A request on its way to its answer. On the heap: what waits for an answer then moves it as a pointer.
#[derive(Debug)]
pub(super) struct Visit {
    pub(super) request: Request,
    pub(super) dialect: Dialect,
    pub(super) heard: Heard,
    pub(super) client: Client,
    /// Why the intake should refuse it.
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

/// The terms of answers, from the settings.
pub(super) fn terms(server: &Server) -> Terms {
    Terms {
        patience: seconds(server.stalled_reader_seconds),
        rate: server.min_bytes_per_second,
        whole: seconds(server.max_stream_seconds),
    }
}

impl Exchanges {
    /// The state that the requests of a connection share.
    pub(super) fn from(&self, peer: Peer) -> From {
        let address = peer.0.ip().to_canonical();
        From {
            usage: self.gate.usage(address),
            address,
            open: OpenExchanges::new(),
            peer,
        }
    }

    /// A request that begins its way. From here on it travels as a pointer.
    pub(super) fn visit(&self, from: &From, request: Request) -> Box<Visit> {
        let heard = Heard::of(request.headers());
        let dialect = match heard.content_type {
            true => Dialect::of(request.headers()),
            false => Dialect::Rest,
        };
        let forwarded = heard.forwarded.then(|| request.headers());
        Box::new(Visit {
            dialect,
            client: self.client(from, forwarded),
            heard,
            request,
            refused: None,
        })
    }

    /// Answers a request to a route; the answer leaves through its exchange.
    pub(super) async fn answer<A: Future<Output = Response>>(
        &self,
        from: &From,
        route: &'static str,
        mut visit: Box<Visit>,
        answer: impl FnOnce(Box<Visit>) -> A,
    ) -> Response {
        let (dialect, now) = (visit.dialect, Instant::now());
        let usage = visit.client.usage.clone();
        let budget = self.budget.of_address(usage.clone());
        let report = {
            let asked = Asked {
                request: &visit.request,
                has_identity: visit.heard.identity,
                protocol: dialect.protocol(),
                route,
                peer: from.peer,
                start: now,
            };
            Report::start(&self.metrics, self.spans.as_ref(), budget.clone(), &asked)
        };
        let record = report.record().clone();

        let is_probe = PROBES.contains(&visit.request.uri().path());
        let probe = is_probe.then(|| usage.probe()).flatten();
        // Refusals are answers, too: those beyond the limits are small, and beyond twice the limits they
        // have no body that a client could leave untouched.
        let is_probe = probe.is_some();
        visit.client.is_probe = is_probe;
        let (used, limit) = (usage.requests.used(), usage.requests.limit());
        let base = match is_probe {
            true => Ok(budget.hold_anyway(BASE)),
            false => budget.hold(BASE),
        };
        let refused = match base.as_ref().err() {
            Some(error) => Some(error.clone()),
            None if is_probe || used < limit => None,
            None => {
                let what = "requests";
                Some(Denied::Address { what, limit }.into())
            }
        };
        let is_bare = base.is_err() || !is_probe && used >= limit.saturating_mul(2);
        let places = Places {
            _request: usage.request(),
            _probe: probe,
            _base: base.unwrap_or_else(|_| budget.hold_anyway(BASE)),
        };
        let exchange = Exchange::new(report, dialect, self.terms, places, from.open.begin(), now);

        let answered = pin!(async {
            match refused {
                Some(error) if is_bare => bare(dialect, &error),
                refused => {
                    visit.refused = refused;
                    answer(visit).await
                }
            }
        });
        let mut response = record.clone().scope(answered).await;
        if let Ok(mut id) = HeaderValue::from_str(record.id()) {
            // Never indexed in HTTP/2: it is another one in each answer, and would push others out of the table.
            id.set_sensitive(true);
            response.headers_mut().insert(REQUEST_ID, id);
        }
        exchange.answer(&mut response);
        response
    }

    /// The client of a request, of which the headers name another than the peer or do not.
    fn client(&self, from: &From, forwarded: Option<&HeaderMap>) -> Client {
        let address = forwarded.map_or(from.address, |headers| {
            let lines = headers.get_all(FORWARDED_FOR).iter();
            let lines = lines.map(HeaderValue::as_bytes);
            self.gate.client(from.address, lines)
        });
        Client {
            usage: match address == from.address {
                true => from.usage.clone(),
                false => self.gate.usage(address),
            },
            address,
            is_probe: false,
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
