//! Metrics, as Prometheus reads them.
//!
//! Each daemon has its own registry, so several in one process do not mix. Counters are looked up once
//! per request, by few names (routes, not paths; formats; kinds of errors); blocks and points then only
//! add to handles. What the service and the system already know (caches,
//! streams, tables, memory) is read at each scrape, in `scrape`.

mod process;
mod scrape;

use std::{
    collections::HashMap,
    sync::{Arc, OnceLock, PoisonError, RwLock},
    time::{Duration, Instant, SystemTime},
};

use metrics::{
    Counter, Gauge, Histogram, Key, KeyName, Label, Level, Metadata, Recorder as _, SharedString,
    Unit,
};
use metrics_exporter_prometheus::{PrometheusBuilder, PrometheusHandle, PrometheusRecorder};

use crate::{error_map, service::Kind};

pub(super) use scrape::endpoint;

/// The protocols, as labels name them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Protocol {
    /// Everything that is no call.
    Rest,
    /// gRPC and gRPC-Web.
    Grpc,
}

impl Protocol {
    const ALL: [Self; 2] = [Self::Rest, Self::Grpc];

    /// The label.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Grpc => "grpc",
        }
    }
}

/// How an answer ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Broken {
    /// The reader went away.
    Client,
    /// We broke it off: a stop, a deadline, a fault.
    Server,
}

impl Broken {
    /// The label.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Client => "client",
            Self::Server => "server",
        }
    }
}

/// The upper ends of the buckets of latencies, in seconds: a small answer takes less than the first,
/// a stream of 10⁹ points minutes.
const BUCKETS: [f64; 17] = [
    0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0,
    60.0, 300.0,
];

/// How often the samples of histograms are aggregated, also without scrapes.
const UPKEEP: Duration = Duration::from_secs(5);

/// What requests add to by protocol and format.
#[derive(Debug)]
pub(super) struct OfFormat {
    /// Seconds until the first byte of the body.
    pub(super) first_byte: Histogram,
    /// Seconds until the end.
    pub(super) whole: Histogram,
    /// Points made.
    pub(super) points: Counter,
    /// Bytes of bodies.
    pub(super) bytes: Counter,
}

/// What requests add to by protocol alone.
#[derive(Debug)]
pub(super) struct OfProtocol {
    /// Requests that are being answered.
    pub(super) in_flight: Gauge,
    refused: Vec<Counter>,
    refused_otherwise: Counter,
    broken: [Counter; 2],
}

impl OfProtocol {
    /// The counter of a reason to refuse; `None` for what only the protocol has a name for.
    pub(super) fn refused(&self, kind: Option<Kind>) -> &Counter {
        let at = kind.and_then(|kind| Kind::ALL.iter().position(|&other| other == kind));
        at.and_then(|at| self.refused.get(at))
            .unwrap_or(&self.refused_otherwise)
    }

    /// The counter of answers that ended early.
    pub(super) const fn broken(&self, by: Broken) -> &Counter {
        match by {
            Broken::Client => &self.broken[0],
            Broken::Server => &self.broken[1],
        }
    }
}

/// What becomes of spans.
#[cfg(feature = "otlp")]
#[derive(Debug)]
pub(super) struct OfSpans {
    /// Sent to the collector.
    pub(super) sent: Counter,
    /// Not sent.
    pub(super) lost: Counter,
}

/// A route, a method and how it ended.
type Outcome = (Protocol, Arc<str>, &'static str, &'static str);

/// A daemon's metrics. Cheap to clone.
#[derive(Clone)]
pub struct Metrics {
    inner: Arc<Inner>,
}

struct Inner {
    recorder: Arc<PrometheusRecorder>,
    handle: PrometheusHandle,
    started: SystemTime,
    protocols: OnceLock<[OfProtocol; 2]>,
    formats: RwLock<HashMap<(Protocol, &'static str), Arc<OfFormat>>>,
    requests: RwLock<HashMap<Outcome, Counter>>,
}

impl std::fmt::Debug for Metrics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Metrics").finish_non_exhaustive()
    }
}

impl Default for Metrics {
    fn default() -> Self {
        let builder = PrometheusBuilder::new();
        // Only an empty list is refused.
        let builder = builder.set_buckets(&BUCKETS);
        let recorder = builder.unwrap_or_default().build_recorder();
        let metrics = Self {
            inner: Arc::new(Inner {
                handle: recorder.handle(),
                recorder: Arc::new(recorder),
                started: SystemTime::now(),
                protocols: OnceLock::new(),
                formats: RwLock::default(),
                requests: RwLock::default(),
            }),
        };
        metrics.describe();
        // Both protocols show from the start, at zero: a rate needs a first value.
        for protocol in Protocol::ALL {
            metrics.protocol(protocol);
            metrics.format(protocol, NO_FORMAT);
        }
        metrics
    }
}

/// The format of answers that are no points.
pub(super) const NO_FORMAT: &str = "none";

const META: Metadata<'static> = Metadata::new("strew", Level::INFO, None);

fn labels<const N: usize>(pairs: [(&'static str, SharedString); N]) -> Vec<Label> {
    let label = |(name, value)| Label::new(name, value);
    pairs.into_iter().map(label).collect()
}

impl Metrics {
    /// What requests by a protocol add to.
    pub(super) fn protocol(&self, protocol: Protocol) -> &OfProtocol {
        let protocols = self
            .inner
            .protocols
            .get_or_init(|| Protocol::ALL.map(|protocol| self.make_protocol(protocol)));
        &protocols[protocol as usize]
    }

    fn make_protocol(&self, protocol: Protocol) -> OfProtocol {
        let name = || SharedString::from(protocol.name());
        let refused = |reason: &'static str| {
            let labels = labels([("protocol", name()), ("reason", reason.into())]);
            self.counter(REJECTED, labels)
        };
        let broken = |by: Broken| {
            let labels = labels([("protocol", name()), ("by", by.name().into())]);
            self.counter(BROKEN, labels)
        };
        OfProtocol {
            in_flight: self.gauge(IN_FLIGHT, labels([("protocol", name())])),
            refused: Kind::ALL
                .map(|kind| refused(error_map::wire(kind).slug))
                .into(),
            refused_otherwise: refused("other"),
            broken: [broken(Broken::Client), broken(Broken::Server)],
        }
    }

    /// What answers in a format add to.
    pub(super) fn format(&self, protocol: Protocol, format: &'static str) -> Arc<OfFormat> {
        let formats = self
            .inner
            .formats
            .read()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = formats.get(&(protocol, format)) {
            return found.clone();
        }
        drop(formats);
        let labels = || {
            labels([
                ("protocol", protocol.name().into()),
                ("format", format.into()),
            ])
        };
        let made = Arc::new(OfFormat {
            first_byte: self.histogram(FIRST_BYTE, labels()),
            whole: self.histogram(WHOLE, labels()),
            points: self.counter(POINTS, labels()),
            bytes: self.counter(BYTES, labels()),
        });
        let mut formats = self
            .inner
            .formats
            .write()
            .unwrap_or_else(PoisonError::into_inner);
        formats.entry((protocol, format)).or_insert(made).clone()
    }

    /// The counter of requests of a route that ended so.
    pub(super) fn requests(
        &self,
        protocol: Protocol,
        route: &Arc<str>,
        method: &'static str,
        status: &'static str,
    ) -> Counter {
        let outcome: Outcome = (protocol, route.clone(), method, status);
        let requests = self
            .inner
            .requests
            .read()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = requests.get(&outcome) {
            return found.clone();
        }
        drop(requests);
        let labels = labels([
            ("protocol", protocol.name().into()),
            ("route", route.to_string().into()),
            ("method", method.into()),
            ("status", status.into()),
        ]);
        let made = self.counter(REQUESTS, labels);
        let mut requests = self
            .inner
            .requests
            .write()
            .unwrap_or_else(PoisonError::into_inner);
        requests.entry(outcome).or_insert(made).clone()
    }

    /// What becomes of spans, by outcome.
    #[cfg(feature = "otlp")]
    pub(super) fn spans(&self) -> OfSpans {
        let outcome = |name: &'static str| self.counter(SPANS, labels([("outcome", name.into())]));
        OfSpans {
            sent: outcome("sent"),
            lost: outcome("lost"),
        }
    }

    /// The counter of reloads with a cause.
    pub(super) fn reloads(&self, cause: &'static str) -> Counter {
        self.counter(RELOADS, labels([("cause", cause.into())]))
    }

    /// The counter of files that a reload refused.
    pub(super) fn refused_tables(&self) -> Counter {
        self.counter(REFUSED_TABLES, vec![])
    }

    /// The counter of panics.
    pub(super) fn panics(&self) -> Counter {
        self.counter(PANICS, vec![])
    }

    /// The counter of TLS handshakes that failed.
    pub(super) fn failed_handshakes(&self) -> Counter {
        self.counter(FAILED_HANDSHAKES, vec![])
    }

    /// Aggregates the samples of histograms while the daemon runs.
    pub(super) fn fold_up(&self) -> impl Future<Output = ()> + Send + use<> {
        let inner = Arc::downgrade(&self.inner);
        async move {
            let mut ticks = tokio::time::interval(UPKEEP);
            while let Some(inner) = inner.upgrade() {
                inner.handle.run_upkeep();
                drop(inner);
                ticks.tick().await;
            }
        }
    }

    fn counter(&self, name: &'static str, labels: Vec<Label>) -> Counter {
        self.inner
            .recorder
            .register_counter(&Key::from_parts(name, labels), &META)
    }

    fn gauge(&self, name: &'static str, labels: Vec<Label>) -> Gauge {
        self.inner
            .recorder
            .register_gauge(&Key::from_parts(name, labels), &META)
    }

    fn histogram(&self, name: &'static str, labels: Vec<Label>) -> Histogram {
        self.inner
            .recorder
            .register_histogram(&Key::from_parts(name, labels), &META)
    }

    fn describe(&self) {
        let recorder = &self.inner.recorder;
        for (name, about) in COUNTERS {
            recorder.describe_counter(KeyName::from(name), None, about.into());
        }
        for (name, about) in GAUGES {
            recorder.describe_gauge(KeyName::from(name), None, about.into());
        }
        for (name, about) in HISTOGRAMS {
            recorder.describe_histogram(KeyName::from(name), Some(Unit::Seconds), about.into());
        }
    }
}

/// Seconds since a moment.
pub(super) fn since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64()
}

const REQUESTS: &str = "strew_requests_total";
const POINTS: &str = "strew_points_total";
const BYTES: &str = "strew_response_bytes_total";
const REJECTED: &str = "strew_rejected_total";
const BROKEN: &str = "strew_broken_total";
const RELOADS: &str = "strew_tables_reloads_total";
const REFUSED_TABLES: &str = "strew_tables_refused_total";
const PANICS: &str = "strew_panics_total";
const FAILED_HANDSHAKES: &str = "strew_tls_handshakes_failed_total";
const SPANS: &str = "strew_spans_total";
const CACHE_HITS: &str = "strew_sampler_cache_hits_total";
const CACHE_MISSES: &str = "strew_sampler_cache_misses_total";
const TABLE_LOADS: &str = "strew_table_loads_total";
const FORGE_ENDED: &str = "strew_forge_jobs_ended_total";
const FORGE_JOBS: &str = "strew_forge_jobs";
const IN_FLIGHT: &str = "strew_requests_in_flight";
const POINTS_IN_FLIGHT: &str = "strew_points_in_flight";
const STREAMS: &str = "strew_streams_in_flight";
const MOST_STREAMS: &str = "strew_streams_limit";
const CACHE_BYTES: &str = "strew_sampler_cache_bytes";
const MEMORY: &str = "process_resident_memory_bytes";
const STARTED: &str = "process_start_time_seconds";
const OPEN_FILES: &str = "process_open_fds";
const THREADS: &str = "process_threads";
const FIRST_BYTE: &str = "strew_time_to_first_byte_seconds";
const WHOLE: &str = "strew_request_duration_seconds";

const COUNTERS: [(&str, &str); 14] = [
    (
        REQUESTS,
        "Requests that were answered, by route and how they ended: a class of HTTP or a gRPC code",
    ),
    (POINTS, "Points made for answers"),
    (BYTES, "Bytes of bodies handed to connections"),
    (REJECTED, "Requests refused, by the kind of error"),
    (
        BROKEN,
        "Answers that ended before they were whole, by who broke them off",
    ),
    (PANICS, "Requests that failed because of a bug"),
    (FAILED_HANDSHAKES, "TLS handshakes that failed"),
    (RELOADS, "How often tables were read again, by cause"),
    (
        REFUSED_TABLES,
        "Files of tables that were refused when they were read again",
    ),
    (
        SPANS,
        "Spans for the collector: sent, or lost because it did not take them",
    ),
    (FORGE_ENDED, "Jobs of the forge that ended, by outcome"),
    (CACHE_HITS, "Requested tables that were ready"),
    (CACHE_MISSES, "Requested tables that had to be loaded"),
    (
        TABLE_LOADS,
        "Requested tables whose files were read for the request: those beyond tables.preload_bytes",
    ),
];
const GAUGES: [(&str, &str); 10] = [
    (FORGE_JOBS, "Jobs of the forge that wait or run"),
    (IN_FLIGHT, "Requests that are being answered"),
    (
        POINTS_IN_FLIGHT,
        "Points that current answers have announced and not made yet",
    ),
    (STREAMS, "Current answers with points"),
    (MOST_STREAMS, "The most answers with points at once"),
    (CACHE_BYTES, "Memory of the tables that are ready"),
    (MEMORY, "Resident memory"),
    (STARTED, "When the process began, in seconds since 1970"),
    (OPEN_FILES, "Open files and sockets"),
    (THREADS, "Threads of the process"),
];
const HISTOGRAMS: [(&str, &str); 2] = [
    (
        FIRST_BYTE,
        "From a request's head to the first byte of the answer's body",
    ),
    (
        WHOLE,
        "From a request's head to the end of the answer's body",
    ),
];
