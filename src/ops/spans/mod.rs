//! Requests as OpenTelemetry spans, sent to a collector (OTLP over gRPC).
//!
//! A request that has ended is put into a queue and forgotten; a task of its own gathers spans and sends
//! them. The queue is bounded: what a collector does not take is lost and counted, and no answer ever
//! waits for one. The crates for it take long to compile and only operators use them: they are the feature
//! `otlp`. In a program without it a collector is refused at the start, and so there are never any spans.

use std::net::SocketAddr;

use super::{identity::Trace, metrics::Broken};

#[cfg(feature = "otlp")]
mod exporter;
#[cfg(feature = "otlp")]
pub(super) use exporter::{Collector, Spans};
#[cfg(not(feature = "otlp"))]
pub(super) use {Absent as Collector, Absent as Spans};

#[derive(Debug, thiserror::Error)]
#[error("{setting} = {value:?}: {problem}")]
pub struct SpansError {
    setting: &'static str,
    value: String,
    problem: String,
}

#[derive(Clone, Debug)]
#[cfg_attr(
    not(feature = "otlp"),
    expect(dead_code, reason = "only an exporter reads it")
)]
pub(in crate::ops) struct Answered<'a> {
    pub(in crate::ops) trace: &'a Trace,
    pub(in crate::ops) request_id: &'a str,
    /// A call's path, or `None` for what is no call.
    pub(in crate::ops) call: Option<&'a str>,
    pub(in crate::ops) route: Option<&'a str>,
    pub(in crate::ops) method: &'static str,
    pub(in crate::ops) address: &'a str,
    pub(in crate::ops) client: SocketAddr,
    pub(in crate::ops) status: Option<u16>,
    pub(in crate::ops) code: Option<u32>,
    pub(in crate::ops) reason: Option<&'static str>,
    pub(in crate::ops) broken: Option<Broken>,
    pub(in crate::ops) format: Option<&'static str>,
    pub(in crate::ops) points: u64,
    pub(in crate::ops) bytes: u64,
    /// Seconds to the first byte, and to the end.
    pub(in crate::ops) first_byte: f64,
    pub(in crate::ops) total: f64,
}

/// In the place of the parts of an exporter.
#[cfg(not(feature = "otlp"))]
#[derive(Clone, Debug)]
pub(super) enum Absent {}

#[cfg(not(feature = "otlp"))]
impl Absent {
    pub(super) fn new(settings: &strew_config::Telemetry) -> Result<Option<Self>, SpansError> {
        let value = settings.otlp_endpoint.clone();
        if value.is_empty() {
            return Ok(None);
        }
        Err(SpansError {
            setting: "telemetry.otlp_endpoint",
            value,
            problem: "this program was built without the feature otlp; allowed: \"\", or a program that was built \
                      with it (cargo build --release --features otlp)"
                .into(),
        })
    }

    pub(super) const fn start(
        &self,
        _: &super::metrics::Metrics,
    ) -> Result<(Self, Self), SpansError> {
        match *self {}
    }

    pub(super) const fn begins_one(&self) -> bool {
        match *self {}
    }

    pub(super) const fn take(&self, _: &Answered<'_>) {
        match *self {}
    }

    pub(super) async fn finish(self) {
        match self {}
    }
}
