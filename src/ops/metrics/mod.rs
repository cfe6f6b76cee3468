//! Metrics, as Prometheus reads them.
//!
//! Each daemon has its own registry, so several in one process do not mix. Labels have few values: routes, not paths;
//! formats; kinds of errors. Figures that the service and the system keep themselves (caches, streams, tables, memory) are
//! read at each scrape, in `scrape`.

mod scrape;

use std::{sync::Arc, time::SystemTime};

use parking_lot::RwLock;
use prometheus::{
    Histogram, HistogramVec, IntCounter, IntCounterVec, IntGauge, Registry,
    register_histogram_vec_with_registry as histograms,
    register_int_counter_vec_with_registry as counters,
    register_int_counter_with_registry as counter, register_int_gauge_vec_with_registry as gauges,
};
use strew_error::Kind;
use tokio_util::sync::CancellationToken;

pub(super) use scrape::{endpoint, resident};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Protocol {
    /// Everything but calls.
    Rest,
    /// gRPC and gRPC-Web.
    Grpc,
}

impl Protocol {
    const ALL: [Self; 2] = [Self::Rest, Self::Grpc];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Grpc => "grpc",
        }
    }
}

/// The side that ended an answer early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Broken {
    Client,
    /// The daemon broke it off: a stop, a deadline, a fault.
    Server,
}

impl Broken {
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

#[derive(Debug)]
struct OfFormat {
    protocol: Protocol,
    format: &'static str,
    points: IntCounter,
    bytes: IntCounter,
    latencies: [Histogram; 2],
}

/// The format of answers without points.
pub(super) const NO_FORMAT: &str = "none";
/// The route of requests to unknown paths.
pub(super) const NO_ROUTE: &str = "none";

#[derive(Clone, Debug)]
pub struct Metrics {
    registry: Registry,
    started: SystemTime,
    pub(super) requests: IntCounterVec,
    /// By protocol.
    in_flight: [IntGauge; 2],
    points: IntCounterVec,
    bytes: IntCounterVec,
    /// Those of formats that have been answered, which are looked up for each frame and answer.
    formats: Arc<RwLock<Vec<Arc<OfFormat>>>>,
    rejected: IntCounterVec,
    broken: IntCounterVec,
    /// Whether the daemon breaks off what is left: from then on no end is the client's.
    pub(super) ends: CancellationToken,
    first_byte: HistogramVec,
    whole: HistogramVec,
    pub(super) reloads: IntCounterVec,
    pub(super) refused_tables: IntCounter,
    pub(super) panics: IntCounter,
    pub(super) failed_handshakes: IntCounter,
    #[cfg(feature = "otlp")]
    pub(super) spans: IntCounterVec,
}

impl Default for Metrics {
    fn default() -> Self {
        const NEW: &str = "valid names and labels, each name once";
        let all = Registry::new();
        let counter = |name, help| counter!(name, help, all).expect(NEW);
        let counters = |name, help, labels: &[_]| counters!(name, help, labels, all).expect(NEW);
        let gauges = |name, help, labels: &[_]| gauges!(name, help, labels, all).expect(NEW);
        let histograms = |name, help, labels: &[_]| {
            histograms!(name, help, labels, BUCKETS.into(), all).expect(NEW)
        };
        let by_format = ["protocol", "format"];
        let in_flight = gauges(
            "strew_requests_in_flight",
            "Requests that are being answered",
            &["protocol"],
        );
        let metrics = Self {
            started: SystemTime::now(),
            requests: counters(
                "strew_requests_total",
                "Requests that were answered, by route and how they ended: a class of HTTP or a gRPC code",
                &["protocol", "route", "method", "status"],
            ),
            in_flight: Protocol::ALL
                .map(|protocol| in_flight.with_label_values(&[protocol.name()])),
            points: counters("strew_points_total", "Points made for answers", &by_format),
            bytes: counters(
                "strew_response_bytes_total",
                "Bytes of bodies handed to connections",
                &by_format,
            ),
            formats: Arc::default(),
            ends: CancellationToken::new(),
            rejected: counters(
                "strew_rejected_total",
                "Requests refused, by the kind of error",
                &["protocol", "reason"],
            ),
            broken: counters(
                "strew_broken_total",
                "Answers that ended before they were whole, by who broke them off",
                &["protocol", "by"],
            ),
            first_byte: histograms(
                "strew_time_to_first_byte_seconds",
                "From a request's head to the first byte of the answer's body",
                &by_format,
            ),
            whole: histograms(
                "strew_request_duration_seconds",
                "From a request's head to the end of the answer's body",
                &by_format,
            ),
            reloads: counters(
                "strew_tables_reloads_total",
                "How often tables were read again, by cause",
                &["cause"],
            ),
            refused_tables: counter(
                "strew_tables_refused_total",
                "Files of tables that were refused when they were read again",
            ),
            panics: counter(
                "strew_panics_total",
                "Requests that failed because of a bug",
            ),
            failed_handshakes: counter(
                "strew_tls_handshakes_failed_total",
                "TLS handshakes that failed",
            ),
            #[cfg(feature = "otlp")]
            spans: counters(
                "strew_spans_total",
                "Spans for the collector: sent, or lost because it did not take them",
                &["outcome"],
            ),
            registry: all,
        };
        // Both protocols show from the start, at zero: a rate needs a first value.
        for protocol in Protocol::ALL {
            metrics.made(protocol, NO_FORMAT, 0, 0);
            metrics.broken(protocol, Broken::Client);
            metrics.broken(protocol, Broken::Server);
            metrics.rejected(protocol, None);
            for kind in Kind::ALL {
                metrics.rejected(protocol, Some(kind));
            }
        }
        metrics
    }
}

impl Metrics {
    pub(super) const fn in_flight(&self, protocol: Protocol) -> &IntGauge {
        &self.in_flight[protocol as usize]
    }

    pub(super) fn made(&self, protocol: Protocol, format: &'static str, points: u64, bytes: u64) {
        let of = self.of_format(protocol, format);
        of.points.inc_by(points);
        of.bytes.inc_by(bytes);
    }

    /// Adds an answer in a format: the seconds until its first byte, and until its end.
    pub(super) fn took(&self, protocol: Protocol, format: &'static str, seconds: [f64; 2]) {
        let of = self.of_format(protocol, format);
        for (latency, seconds) in of.latencies.iter().zip(seconds) {
            latency.observe(seconds);
        }
    }

    fn of_format(&self, protocol: Protocol, format: &'static str) -> Arc<OfFormat> {
        let is_it = |of: &&Arc<OfFormat>| of.protocol == protocol && of.format == format;
        if let Some(known) = self.formats.read().iter().find(is_it) {
            return known.clone();
        }
        let labels = [protocol.name(), format];
        let of = Arc::new(OfFormat {
            protocol,
            format,
            points: self.points.with_label_values(&labels),
            bytes: self.bytes.with_label_values(&labels),
            latencies: [&self.first_byte, &self.whole].map(|of| of.with_label_values(&labels)),
        });
        self.formats.write().push(of.clone());
        of
    }

    /// The counter of refused requests with a reason; `None` for errors that only the protocol has a name for.
    pub(super) fn rejected(&self, protocol: Protocol, kind: Option<Kind>) -> IntCounter {
        let reason = kind.map_or("other", Kind::slug);
        self.rejected.with_label_values(&[protocol.name(), reason])
    }

    pub(super) fn broken(&self, protocol: Protocol, by: Broken) -> IntCounter {
        self.broken.with_label_values(&[protocol.name(), by.name()])
    }
}
