//! Every request is seen from its head to the last byte of its answer: named, counted, logged.
//!
//! This is the outermost layer. The id goes back with every answer, also with errors, and stands in
//! every line of the log that the request causes. The access line (target `strew::access`) is written
//! when the answer has ended, at `info`; for probes and scrapes at `debug`.

use std::{
    net::SocketAddr,
    pin::Pin,
    sync::Arc,
    task::{Context, Poll},
    time::Instant,
};

use axum::{
    Router,
    body::Body,
    extract::{MatchedPath, Request, State},
    middleware::{self, Next},
    response::Response,
};
use bytes::Bytes;
use http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use http_body::{Body as HttpBody, Frame, SizeHint};
use tracing::{Instrument as _, Span};

use super::{
    calls,
    connections::Peer,
    identity::{Identity, REQUEST_ID},
    metrics::{Broken, Door, Metrics, NO_FORMAT, since},
    spans::{Answered, Spans},
};
use crate::{error_map, grpc, service::Record};

/// A router whose requests are seen, and sent as spans where these are taken.
pub(super) fn observed(router: Router, metrics: Metrics, spans: Option<Spans>) -> Router {
    router.layer(middleware::from_fn_with_state((metrics, spans), observe))
}

async fn observe(
    State((metrics, spans)): State<(Metrics, Option<Spans>)>,
    request: Request,
    next: Next,
) -> Response {
    let watch = Watch::start(metrics, spans, &request);
    let (record, span) = (watch.record.clone(), watch.span.clone());
    let answered = record.scope(next.run(request)).instrument(span);
    let mut response = Seen { watch }.over(answered).await;
    let id = HeaderValue::from_str(response.body().watch.record.id());
    if let Ok(id) = id {
        response.headers_mut().insert(REQUEST_ID, id);
    }
    response.map(Body::new)
}

/// A watch whose answer is still being made.
struct Seen {
    watch: Watch,
}

impl Seen {
    /// The answer, watched on.
    async fn over(mut self, answer: impl Future<Output = Response>) -> Response<Observed> {
        let response = answer.await;
        self.watch.head(&response);
        let watch = self.watch;
        response.map(|body| Observed { body, watch })
    }
}

/// How an answer stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stand {
    Open,
    Whole,
    BrokenOff,
}

/// What is known of a request and its answer; tells it when dropped.
#[derive(Debug)]
struct Watch {
    metrics: Metrics,
    spans: Option<Spans>,
    record: Arc<Record>,
    identity: Identity,
    span: Span,
    start: Instant,
    door: Door,
    route: Arc<str>,
    method: Method,
    address: String,
    client: Option<SocketAddr>,
    status: Option<StatusCode>,
    stand: Stand,
    /// How many bytes the answer has, where it said so.
    expected: Option<u64>,
    bytes: u64,
    first_byte: Option<f64>,
    /// How many points are in the metrics already.
    counted: u64,
}

/// The longest address that goes into the log.
const LONGEST: usize = 500;

impl Watch {
    fn start(metrics: Metrics, spans: Option<Spans>, request: &Request) -> Self {
        let begins_one = || spans.as_ref().is_some_and(Spans::begins_one);
        let identity = Identity::of(request.headers(), begins_one);
        let door = match calls::is_grpc(request.headers()) {
            true => Door::Grpc,
            false => Door::Rest,
        };
        metrics.door(door).in_flight.increment(1.0);
        let asked = request.uri().path_and_query();
        let asked = asked.map_or("", |asked| asked.as_str());
        let trace = identity.trace.as_ref().map(|trace| &*trace.trace);
        // At the level of errors, so that they have it however little is logged.
        let span = tracing::error_span!("request", request_id = identity.id, trace_id = trace);
        Self {
            record: Record::new(&identity.id),
            span,
            start: Instant::now(),
            route: route(request),
            method: request.method().clone(),
            address: asked.chars().take(LONGEST).collect(),
            client: request.extensions().get::<Peer>().map(|peer| peer.0),
            status: None,
            stand: Stand::Open,
            expected: None,
            bytes: 0,
            first_byte: None,
            counted: 0,
            metrics,
            spans,
            identity,
            door,
        }
    }

    /// The head of the answer is made.
    fn head(&mut self, response: &Response) {
        self.status = Some(response.status());
        if let Some(code) = code(response.headers()) {
            self.record.ended(code);
        }
        let length = response.headers().get(header::CONTENT_LENGTH);
        let length = length.and_then(|length| length.to_str().ok()?.parse().ok());
        self.expected = length.or_else(|| response.body().size_hint().exact());
        // Nobody reads the body of such an answer.
        let is_bodiless = self.method == Method::HEAD
            || response.body().is_end_stream()
            || response.status() == StatusCode::NOT_MODIFIED;
        if is_bodiless {
            self.stand = Stand::Whole;
        }
    }

    /// A part of the body goes out.
    fn part(&mut self, bytes: usize) {
        let bytes = bytes as u64;
        if self.first_byte.is_none() && bytes > 0 {
            self.first_byte = Some(since(self.start));
        }
        self.bytes += bytes;
        // A reader who has all that was announced does not ask for an end.
        if self.expected.is_some_and(|expected| self.bytes >= expected) {
            self.stand = Stand::Whole;
        }
        self.count(bytes);
    }

    /// Brings the counters of bytes and points up to date, so that long answers show while they run.
    fn count(&mut self, bytes: u64) {
        let format = self.record.format().unwrap_or(NO_FORMAT);
        let format = self.metrics.format(self.door, format);
        format.bytes.increment(bytes);
        let points = self.record.points();
        format.points.increment(points - self.counted);
        self.counted = points;
    }

    /// Who broke the answer off, if somebody did.
    fn broken(&self) -> Option<Broken> {
        match self.stand {
            Stand::Open => Some(Broken::Client),
            Stand::BrokenOff => Some(Broken::Server),
            // A call says with its last word that it is not complete.
            Stand::Whole => {
                let has_failed = self.record.code().is_some_and(|code| code != 0);
                (has_failed && self.record.points() > 0).then_some(Broken::Server)
            }
        }
    }

    /// How it ended, as a label: few values.
    fn outcome(&self) -> &'static str {
        match (self.door, self.record.code(), self.status) {
            (Door::Grpc, Some(code), _) => grpc::code_name(code),
            (Door::Grpc, None, Some(_)) if self.stand == Stand::Open => "CANCELLED",
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

    fn is_refused(&self) -> bool {
        let failed = |status: StatusCode| status.is_client_error() || status.is_server_error();
        let has_failed = self.record.code().is_some_and(|code| code != 0);
        self.status.is_some_and(failed) || has_failed && self.record.points() == 0
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.count(0);
        let total = since(self.start);
        let first = self.first_byte.unwrap_or(total);
        let broken = self.broken();
        let outcome = self.outcome();
        let door = self.metrics.door(self.door);
        door.in_flight.decrement(1.0);
        if self.is_refused() {
            door.refused(self.record.refused()).increment(1);
        }
        if let Some(by) = broken {
            door.broken(by).increment(1);
        }
        let format = self.record.format();
        let of_format = self.metrics.format(self.door, format.unwrap_or(NO_FORMAT));
        of_format.first_byte.record(first);
        of_format.whole.record(total);
        let method = method_name(&self.method);
        let requests = self
            .metrics
            .requests(self.door, &self.route, method, outcome);
        requests.increment(1);

        let trace = self.identity.trace.as_ref();
        let reason = self.record.refused().map(|kind| error_map::wire(kind).slug);
        let client = self.client.map(|client| client.to_string());
        macro_rules! line {
            ($level:ident) => {
                tracing::$level!(
                    target: "strew::access",
                    parent: None,
                    request_id = self.record.id(),
                    trace_id = trace.map(|trace| &*trace.trace),
                    span_id = trace.map(|trace| &*trace.span),
                    parent_id = trace.and_then(|trace| trace.parent.as_deref()),
                    client,
                    door = self.door.name(),
                    method = self.method.as_str(),
                    address = self.address,
                    route = &*self.route,
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
        if let "/livez" | "/readyz" | "/metrics" = &*self.route {
            line!(debug);
            return;
        }
        line!(info);
        if let (Some(spans), Some(trace)) = (&self.spans, trace) {
            let is_call = self.door == Door::Grpc && &*self.route != NO_ROUTE;
            spans.take(&Answered {
                trace,
                request_id: self.record.id(),
                call: is_call.then_some(&*self.route),
                route: Some(&*self.route).filter(|route| *route != NO_ROUTE),
                method,
                address: &self.address,
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

/// With the digits that mean something.
fn milliseconds(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e3
}

/// The route of what has none.
const NO_ROUTE: &str = "none";

/// The route of a request: one of those there are, never the path as it was written.
fn route(request: &Request) -> Arc<str> {
    let path = request.uri().path();
    if let Some(method) = grpc::METHODS.into_iter().find(|&method| method == path) {
        return method.into();
    }
    let matched = request.extensions().get::<MatchedPath>();
    matched.map_or(NO_ROUTE, MatchedPath::as_str).into()
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

/// The code of a call that has ended.
fn code(headers: &HeaderMap) -> Option<u32> {
    headers.get("grpc-status")?.to_str().ok()?.parse().ok()
}

/// The body of an answer, seen.
#[derive(Debug)]
struct Observed {
    body: Body,
    watch: Watch,
}

impl HttpBody for Observed {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        let Self { body, watch } = &mut *self;
        let polled = {
            let _entered = watch.span.enter();
            Pin::new(&mut *body).poll_frame(cx)
        };
        match &polled {
            Poll::Pending => {}
            Poll::Ready(None) => watch.stand = Stand::Whole,
            Poll::Ready(Some(Err(_))) => watch.stand = Stand::BrokenOff,
            Poll::Ready(Some(Ok(frame))) => {
                watch.part(frame.data_ref().map_or(0, Bytes::len));
                if frame.is_trailers() || body.is_end_stream() {
                    watch.stand = Stand::Whole;
                }
            }
        }
        polled
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

/// Notes the code of a call's answer, which comes at its end. Inside of what rewrites answers for
/// web pages.
pub(super) fn coded(response: Response) -> Response {
    let Some(record) = Record::current() else {
        return response;
    };
    if let Some(code) = code(response.headers()) {
        record.ended(code);
        return response;
    }
    response.map(|body| Body::new(Coded { body, record }))
}

/// The body of a call's answer.
struct Coded {
    body: Body,
    record: Arc<Record>,
}

impl HttpBody for Coded {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        let polled = Pin::new(&mut self.body).poll_frame(cx);
        if let Poll::Ready(Some(Ok(frame))) = &polled
            && let Some(code) = frame.trailers_ref().and_then(code)
        {
            self.record.ended(code);
        }
        polled
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}
