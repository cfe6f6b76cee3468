//! A request that has ended, as a span: names are those of OpenTelemetry's semantic conventions where
//! these have one, and begin with `strew.` elsewhere.

use std::time::{Duration, SystemTime};

use opentelemetry::{
    InstrumentationScope, KeyValue, SpanId, TraceFlags, TraceId, Value,
    trace::{SpanContext, SpanKind, Status, TraceState},
};
use opentelemetry_sdk::trace::{SpanData, SpanEvents, SpanLinks};

use super::Answered;
use crate::ops::metrics::Broken;

impl Answered<'_> {
    /// The span of a request that ended just now; `None` if its trace is not kept.
    pub(super) fn span(&self) -> Option<SpanData> {
        if !self.trace.is_sampled {
            return None;
        }
        let trace_id = TraceId::from_hex(&self.trace.trace).ok()?;
        let of_span = |text: &str| SpanId::from_hex(text).ok();
        let parent = self.trace.parent.as_deref().and_then(of_span);
        let end = SystemTime::now();
        let total = Duration::try_from_secs_f64(self.total).unwrap_or_default();
        Some(SpanData {
            span_context: SpanContext::new(
                trace_id,
                of_span(&self.trace.span)?,
                TraceFlags::SAMPLED,
                false,
                TraceState::NONE,
            ),
            parent_span_id: parent.unwrap_or(SpanId::INVALID),
            parent_span_is_remote: parent.is_some(),
            span_kind: SpanKind::Server,
            name: self.name().into(),
            // The clock of the day may be set meanwhile; how long it took is measured by another.
            start_time: end.checked_sub(total).unwrap_or(end),
            end_time: end,
            attributes: self.attributes(),
            dropped_attributes_count: 0,
            events: SpanEvents::default(),
            links: SpanLinks::default(),
            status: self.outcome(),
            instrumentation_scope: InstrumentationScope::builder("strew")
                .with_version(env!("CARGO_PKG_VERSION"))
                .build(),
        })
    }

    fn name(&self) -> String {
        match (self.call, self.route) {
            (Some(call), _) => call.trim_start_matches('/').into(),
            (None, Some(route)) => format!("{} {route}", self.method),
            (None, None) => self.method.into(),
        }
    }

    /// Whether it is our fault that it did not end well.
    fn outcome(&self) -> Status {
        let is_ours = match self.code {
            // UNKNOWN, DEADLINE_EXCEEDED, UNIMPLEMENTED, INTERNAL, UNAVAILABLE, DATA_LOSS.
            Some(code) => matches!(code, 2 | 4 | 12 | 13 | 14 | 15),
            None => self.status.is_some_and(|status| status >= 500),
        };
        if is_ours || self.broken == Some(Broken::Server) {
            Status::error(self.reason.unwrap_or("broken off"))
        } else {
            Status::Unset
        }
    }

    fn attributes(&self) -> Vec<KeyValue> {
        let (path, query) = match self.address.split_once('?') {
            Some((path, query)) => (path, Some(query)),
            None => (self.address, None),
        };
        let call = self.call.and_then(|call| call[1..].split_once('/'));
        let text = |value: Option<&str>| value.map(|value| Value::from(value.to_owned()));
        let number = |value: u64| Some(Value::I64(i64::try_from(value).unwrap_or(i64::MAX)));
        let pairs = [
            ("http.request.method", text(Some(self.method))),
            ("http.route", text(self.route.filter(|_| call.is_none()))),
            (
                "http.response.status_code",
                self.status.and_then(|status| number(status.into())),
            ),
            ("http.response.body.size", number(self.bytes)),
            ("url.path", text(Some(path))),
            ("url.query", text(query)),
            (
                "network.peer.address",
                text(self.client.map(|peer| peer.ip().to_string()).as_deref()),
            ),
            (
                "network.peer.port",
                self.client.and_then(|peer| number(peer.port().into())),
            ),
            ("rpc.system", text(call.map(|_| "grpc"))),
            ("rpc.service", text(call.map(|(service, _)| service))),
            ("rpc.method", text(call.map(|(_, method)| method))),
            (
                "rpc.grpc.status_code",
                self.code.and_then(|code| number(code.into())),
            ),
            ("error.type", text(self.reason)),
            ("strew.request_id", text(Some(self.request_id))),
            ("strew.format", text(self.format)),
            ("strew.points", number(self.points)),
            (
                "strew.broken",
                text(self.broken.map(|broken| broken.name())),
            ),
            (
                "strew.first_byte_seconds",
                Some(Value::F64(self.first_byte)),
            ),
        ];
        let known = pairs.into_iter();
        known
            .filter_map(|(key, value)| Some(KeyValue::new(key, value?)))
            .collect()
    }
}
