//! The one report of an exchange: counters, the access line, a span.
//!
//! It is made when the exchange is over. The access line (target `strew::access`) has the level
//! `info`, for probes and scrapes `debug`.

use std::{borrow::Cow, cell::LazyCell, net::SocketAddr, sync::Arc};

use bytes::Bytes;
use http::{Method, StatusCode, header, uri::PathAndQuery};
use http_body::{Body as _, Frame};
use strew_error::{Kind, without_keys};
use strew_service::{Budget, Record};
use tokio::time::Instant;

use crate::{
    body::{Request, Response},
    grpc,
    ops::{
        dialect::{Ending, grpc_code},
        identity::{self, Trace},
        metrics::{Broken, Metrics, NO_FORMAT, NO_ROUTE, Protocol},
        spans::{Answered, Spans},
        telemetry::ACCESS,
    },
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stand {
    Open,
    Whole,
    BrokenOff(Broken),
}

/// The facts about a request and its answer; reported when dropped.
pub(super) struct Report {
    metrics: Arc<Metrics>,
    spans: Option<Spans>,
    record: Arc<Record>,
    trace: Option<Trace>,
    /// When its head was there.
    start: Instant,
    protocol: Protocol,
    method: Method,
    address: Option<PathAndQuery>,
    client: SocketAddr,
    status: Option<StatusCode>,
    stand: Stand,
    /// The length of the answer in bytes, if it was announced.
    expected: Option<u64>,
    bytes: u64,
    first_byte: Option<f64>,
    /// The number of points that the metrics have already.
    counted: u64,
}

/// The bytes of an address that go into the log.
const LONGEST: usize = 500;

impl Report {
    pub(super) fn start(
        (metrics, spans): (&Arc<Metrics>, Option<&Spans>),
        budget: Budget,
        request: &Request,
        (protocol, client): (Protocol, SocketAddr),
        start: Instant,
    ) -> Self {
        let begins_one = || spans.is_some_and(Spans::begins_one);
        let trace = Trace::of(request.headers(), begins_one);
        let id = identity::id(request.headers());
        metrics.in_flight(protocol).inc();
        let of = trace.as_ref().map(|trace| &*trace.trace);
        Self {
            record: Record::new(id, of, budget),
            trace,
            start,
            method: request.method().clone(),
            address: request.uri().path_and_query().cloned(),
            client,
            status: None,
            stand: Stand::Open,
            expected: None,
            bytes: 0,
            first_byte: None,
            counted: 0,
            metrics: metrics.clone(),
            spans: spans.cloned(),
            protocol,
        }
    }

    pub(super) const fn record(&self) -> &Arc<Record> {
        &self.record
    }

    pub(super) fn whole(&mut self) {
        self.stand = Stand::Whole;
    }

    pub(super) fn broken_off(&mut self) {
        self.stand = Stand::BrokenOff(Broken::Server);
    }

    pub(super) fn cut(&mut self, why: Ending) {
        self.stand = Stand::BrokenOff(why.by());
        if let (Protocol::Grpc, Some(code)) = (self.protocol, why.code()) {
            self.record.ended(code);
        }
    }

    pub(super) fn trailers(&mut self, frame: &Frame<Bytes>) {
        if let Some(code) = frame.trailers_ref().and_then(grpc_code) {
            self.record.ended(code);
        }
        self.stand = Stand::Whole;
    }

    pub(super) fn head(&mut self, response: &Response) {
        self.status = Some(response.status());
        if self.protocol == Protocol::Grpc
            && let Some(code) = grpc_code(response.headers())
        {
            self.record.ended(code);
        }
        let length = || -> Option<u64> {
            let length = response.headers().get(header::CONTENT_LENGTH)?;
            length.to_str().ok()?.parse().ok()
        };
        let exact = response.body().size_hint().exact();
        self.expected = exact.filter(|&exact| exact > 0).or_else(length).or(exact);
        // Such an answer has no body to read.
        let is_bodiless = self.method == Method::HEAD
            || response.body().is_end_stream()
            || response.status() == StatusCode::NOT_MODIFIED;
        if is_bodiless {
            self.stand = Stand::Whole;
        }
    }

    pub(super) fn part(&mut self, bytes: usize, now: Instant) {
        let bytes = bytes as u64;
        if self.first_byte.is_none() && bytes > 0 {
            let took = now.saturating_duration_since(self.start);
            self.first_byte = Some(took.as_secs_f64());
        }
        self.bytes += bytes;
        // A reader that has all that was announced does not poll for an end.
        if self.expected.is_some_and(|expected| self.bytes >= expected) {
            self.stand = Stand::Whole;
        }
        self.count(bytes);
    }

    /// Brings the counters of bytes and points up to date, so that long answers show while they run.
    fn count(&mut self, bytes: u64) {
        let format = self.record.format().unwrap_or(NO_FORMAT);
        let points = self.record.points();
        if points == self.counted && bytes == 0 {
            return;
        }
        self.metrics
            .made(self.protocol, format, points - self.counted, bytes);
        self.counted = points;
    }

    fn broken(&self) -> Option<Broken> {
        match self.stand {
            Stand::Open if self.metrics.ends.is_cancelled() => Some(Broken::Server),
            Stand::Open => Some(Broken::Client),
            Stand::BrokenOff(by) => Some(by),
            // A call says with its last word that it is not complete.
            Stand::Whole => {
                let has_failed = self.record.code().is_some_and(|code| code != 0);
                (has_failed && self.record.points() > 0).then_some(Broken::Server)
            }
        }
    }

    /// The outcome as a label, which has few values.
    fn outcome(&self) -> &'static str {
        match (self.protocol, self.record.code(), self.status) {
            (Protocol::Grpc, Some(code), _) => grpc::code_name(code),
            (Protocol::Grpc, None, Some(_)) if self.stand == Stand::Open => "CANCELLED",
            (_, _, Some(status)) => match status.as_u16() {
                100..=199 => "1xx",
                200..=299 => "2xx",
                300..=399 => "3xx",
                400..=499 => "4xx",
                _ => "5xx",
            },
            (_, _, None) => "aborted",
        }
    }

    /// Path and query, as far as they are shown, without keys.
    fn address(&self) -> Cow<'_, str> {
        let whole = self.address.as_ref().map_or("", PathAndQuery::as_str);
        // Before the end of a key is cut off.
        let whole = without_keys(whole);
        // A character has 4 bytes at most.
        let ends = (LONGEST - 3..=LONGEST).rev();
        let cut = ends.filter_map(|end| whole.get(..end)).next();
        match cut {
            Some(cut) if cut.len() < whole.len() => cut.to_owned().into(),
            _ => whole,
        }
    }

    fn is_refused(&self) -> bool {
        let failed = |status: StatusCode| status.is_client_error() || status.is_server_error();
        let has_failed = self.record.code().is_some_and(|code| code != 0);
        self.status.is_some_and(failed) || has_failed && self.record.points() == 0
    }
}

impl Drop for Report {
    fn drop(&mut self) {
        self.count(0);
        let total = self.start.elapsed().as_secs_f64();
        let first = self.first_byte.unwrap_or(total);
        let broken = self.broken();
        let outcome = self.outcome();
        let (metrics, protocol) = (&self.metrics, self.protocol);
        let route = self.record.route().unwrap_or(NO_ROUTE);
        metrics.in_flight(protocol).dec();
        if self.is_refused() {
            metrics.rejected(protocol, self.record.refused()).inc();
        }
        if let Some(by) = broken {
            metrics.broken(protocol, by).inc();
        }
        let format = self.record.format();
        metrics.took(protocol, format.unwrap_or(NO_FORMAT), [first, total]);
        let method = method_name(&self.method);
        let labels = [protocol.name(), route, method, outcome];
        metrics.requests.with_label_values(&labels).inc();

        // Only those who read it look for keys in an address.
        let (trace, address) = (self.trace.as_ref(), LazyCell::new(|| self.address()));
        let reason = self.record.refused().map(Kind::slug);
        macro_rules! line {
            ($level:ident) => {
                tracing::$level!(
                    target: ACCESS,
                    parent: None,
                    request_id = self.record.id(),
                    trace_id = trace.map(|trace| &*trace.trace),
                    span_id = trace.map(|trace| &*trace.span),
                    parent_id = trace.and_then(|trace| trace.parent.as_deref()),
                    client = %self.client,
                    protocol = self.protocol.name(),
                    method = self.method.as_str(),
                    address = &**address,
                    route,
                    status = self.status.map(|status| status.as_u16()),
                    outcome,
                    reason,
                    broken = broken.map(Broken::name),
                    format,
                    points = self.record.points(),
                    bytes = self.bytes,
                    first_byte_ms = milliseconds(first),
                    total_ms = milliseconds(total),
                    "answered"
                )
            };
        }
        // Probes and scrapes come every few seconds and say nothing.
        if let "/livez" | "/readyz" | "/metrics" = route {
            line!(debug);
            return;
        }
        line!(info);
        if let (Some(spans), Some(trace)) = (&self.spans, trace) {
            let is_call = self.protocol == Protocol::Grpc && route != NO_ROUTE;
            spans.take(&Answered {
                trace,
                request_id: self.record.id(),
                call: is_call.then_some(route),
                route: Some(route).filter(|route| *route != NO_ROUTE),
                method,
                address: &address,
                client: self.client,
                status: self.status.map(|status| status.as_u16()),
                code: self.record.code(),
                reason,
                broken,
                format,
                points: self.record.points(),
                bytes: self.bytes,
                first_byte: first,
                total,
            });
        }
    }
}

fn milliseconds(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e3
}

/// A method's name, if it is a usual one: clients can make up others.
fn method_name(method: &Method) -> &'static str {
    match *method {
        Method::GET => "GET",
        Method::HEAD => "HEAD",
        Method::POST => "POST",
        Method::OPTIONS => "OPTIONS",
        _ => "other",
    }
}
