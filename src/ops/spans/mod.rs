//! Requests as OpenTelemetry spans, sent to a collector (OTLP over gRPC).
//!
//! A request that has ended is put into a queue and forgotten; a task of its own gathers spans and sends
//! them. The queue is bounded: what a collector does not take is lost and counted, and no answer ever
//! waits for one. The crates for it take long to compile and only operators use them: they are the feature
//! `otlp`.

mod answered;
#[cfg_attr(not(feature = "otlp"), path = "absent.rs")]
mod exporter;
#[cfg(feature = "otlp")]
mod span;

pub(super) use answered::Answered;
pub(super) use exporter::{Collector, Spans};

/// Why spans cannot be sent.
#[derive(Debug, thiserror::Error)]
#[error("{setting} = {value:?}: {problem}")]
pub struct SpansError {
    setting: &'static str,
    value: String,
    problem: String,
}
