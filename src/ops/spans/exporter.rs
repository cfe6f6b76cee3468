//! The exporter of a program with the feature `otlp`. The SDK's own tracer is not used, as requests are watched and named
//! already (`exchange`, `identity`), nor its batches, which do not say how many spans they drop.
//!
//! Names of attributes are those of OpenTelemetry's semantic conventions where these have one, and begin with `strew.`
//! elsewhere.

use std::{
    sync::Arc,
    time::{Duration, SystemTime},
};

use opentelemetry::{
    InstrumentationScope, KeyValue, SpanId, TraceFlags, TraceId, Value,
    trace::{SpanContext, SpanKind, Status, TraceState},
};
use opentelemetry_otlp::{
    SpanExporter, WithExportConfig as _, WithTonicConfig as _,
    tonic_types::transport::{Certificate, ClientTlsConfig},
};
use opentelemetry_sdk::{
    Resource,
    trace::{SpanData, SpanEvents, SpanExporter as _, SpanLinks},
};
use prometheus::IntCounter;
use strew_config::{self as config, Telemetry as Settings, bounded_file};
use tokio::sync::mpsc;
use tokio_util::{sync::CancellationToken, task::AbortOnDropHandle};

use super::{Answered, SpansError};
use crate::ops::{
    identity,
    metrics::{Broken, Metrics},
    telemetry::LogThrottle,
    tls::certificates,
};

/// The most spans of one message: some 0.5 MB, where collectors take 4 MiB.
const MOST: usize = 512;

/// The time that the first span of a message waits for more.
const DELAY: Duration = Duration::from_secs(1);

pub(in crate::ops) struct Collector {
    settings: Settings,
    ca: Option<Vec<u8>>,
}

impl Collector {
    pub(in crate::ops) fn new(settings: &Settings) -> Result<Option<Self>, SpansError> {
        if settings.otlp_endpoint.is_empty() {
            return Ok(None);
        }
        let ca = match settings.is_https() {
            false => None,
            true => Some(read_authorities(settings)?),
        };
        Ok(Some(Self {
            settings: settings.clone(),
            ca,
        }))
    }

    /// Starts to send, on the tokio runtime that this is called in. A collector that is not there yet
    /// may come later.
    pub(in crate::ops) fn start(&self, metrics: &Metrics) -> Result<(Spans, Sending), SpansError> {
        let settings = &self.settings;
        let timeout = config::seconds(settings.export_timeout_seconds);
        let mut builder = SpanExporter::builder()
            .with_tonic()
            .with_endpoint(settings.otlp_endpoint.clone())
            .with_timeout(timeout);
        if let Some(ca) = &self.ca {
            let tls = ClientTlsConfig::new().ca_certificate(Certificate::from_pem(ca));
            builder = builder.with_tls_config(tls);
        }
        let mut exporter = builder.build().map_err(|error| SpansError {
            setting: "telemetry.otlp_endpoint",
            value: settings.otlp_endpoint.clone(),
            problem: error.to_string(),
        })?;
        exporter.set_resource(&resource(&settings.service_name));
        let (sender, queue) = mpsc::channel(settings.max_queued_spans);
        let counter = |outcome| metrics.spans.with_label_values(&[outcome]);
        let lost = counter("lost");
        let stop = CancellationToken::new();
        let task = Task {
            exporter,
            queue,
            sent: counter("sent"),
            lost: lost.clone(),
            failed: LogThrottle::default(),
        };
        let task = AbortOnDropHandle::new(tokio::spawn(task.run(stop.clone())));
        let spans = Spans {
            sender,
            sample_ratio: settings.sample_ratio,
            lost,
            full: Arc::default(),
        };
        Ok((
            spans,
            Sending {
                stop,
                task,
                timeout,
            },
        ))
    }
}

const MOST_BYTES: u64 = 4 << 20;

fn read_authorities(settings: &Settings) -> Result<Vec<u8>, SpansError> {
    let wrong = |problem| SpansError {
        setting: "telemetry.otlp_ca",
        value: settings.otlp_ca.display().to_string(),
        problem,
    };
    let pem = bounded_file::read(&settings.otlp_ca, MOST_BYTES)
        .map_err(|error| wrong(format!("it cannot be read: {error}")))?;
    certificates(&pem).map_err(wrong)?;
    Ok(pem)
}

/// The sender: the attributes of OTEL_RESOURCE_ATTRIBUTES, and our name and version.
fn resource(service_name: &str) -> Resource {
    Resource::builder()
        .with_service_name(service_name.to_owned())
        .with_attribute(KeyValue::new("service.version", env!("CARGO_PKG_VERSION")))
        .build()
}

#[derive(Clone, Debug)]
pub(in crate::ops) struct Spans {
    sender: mpsc::Sender<SpanData>,
    sample_ratio: f64,
    lost: IntCounter,
    full: Arc<LogThrottle>,
}

impl Spans {
    /// Whether a request that comes without a trace begins one.
    pub(in crate::ops) fn begins_one(&self) -> bool {
        // In [0, 1), so that a ratio of 1 is all and 0 none.
        let drawn = (identity::next() >> 11) as f64 / (1u64 << 53) as f64;
        drawn < self.sample_ratio
    }

    /// Has a request sent as a span, if its trace is one that is kept.
    pub(in crate::ops) fn take(&self, answered: &Answered<'_>) {
        let Some(span) = answered.span() else {
            return;
        };
        if self.sender.try_send(span).is_err() {
            self.lost.inc();
            if let Some(spans) = self.full.record() {
                tracing::warn!(
                    spans,
                    "lost: the collector takes spans slower than they come"
                );
            }
        }
    }
}

pub(in crate::ops) struct Sending {
    stop: CancellationToken,
    task: AbortOnDropHandle<()>,
    timeout: Duration,
}

impl Sending {
    /// Sends what is left, for no longer than sending may take.
    pub(in crate::ops) async fn finish(self) {
        self.stop.cancel();
        if tokio::time::timeout(self.timeout, self.task).await.is_err() {
            tracing::warn!("the collector did not take the last spans in time");
        }
    }
}

struct Task {
    exporter: SpanExporter,
    queue: mpsc::Receiver<SpanData>,
    sent: IntCounter,
    lost: IntCounter,
    failed: LogThrottle,
}

impl Task {
    /// Sends until it is stopped, or all senders are gone, and the queue is empty.
    async fn run(mut self, stop: CancellationToken) {
        let mut batch = vec![];
        let mut is_open = true;
        while is_open {
            is_open = tokio::select! {
                is_open = gather(&mut self.queue, &mut batch) => is_open,
                () = stop.cancelled() => false,
            };
            self.send(&mut batch).await;
        }
        self.queue.close();
        while self.queue.recv_many(&mut batch, MOST).await > 0 {
            self.send(&mut batch).await;
        }
    }

    async fn send(&self, batch: &mut Vec<SpanData>) {
        if batch.is_empty() {
            return;
        }
        let spans = batch.len() as u64;
        match self.exporter.export(std::mem::take(batch)).await {
            Ok(()) => self.sent.inc_by(spans),
            Err(error) => {
                self.lost.inc_by(spans);
                if let Some(times) = self.failed.record() {
                    tracing::warn!(%error, times, "spans could not be sent to the collector");
                }
            }
        }
    }
}

/// Fills a batch: as soon as there is one span it waits a moment for more; whether more may come. What it
/// has taken stays in the batch when it is dropped.
async fn gather(queue: &mut mpsc::Receiver<SpanData>, batch: &mut Vec<SpanData>) -> bool {
    if queue.recv_many(batch, MOST).await == 0 {
        return false;
    }
    let more = async {
        while batch.len() < MOST && queue.recv_many(batch, MOST - batch.len()).await > 0 {}
    };
    let _ = tokio::time::timeout(DELAY, more).await;
    true
}

impl Answered<'_> {
    /// The span of a request that ended just now; `None` if its trace is not kept.
    fn span(&self) -> Option<SpanData> {
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
        let peer = self.client.ip().to_string();
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
            ("network.peer.address", text(Some(&peer))),
            ("network.peer.port", number(self.client.port().into())),
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
            ("strew.broken", text(self.broken.map(Broken::name))),
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
