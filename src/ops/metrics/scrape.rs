//! `GET /metrics`: the counters, and the figures of the moment.

use std::{sync::Arc, time::UNIX_EPOCH};

use axum::extract::State;
use prometheus::{Counter, Gauge, Opts, Registry, TextEncoder, core::Collector};
use strew_service::Service;

use super::{Metrics, process::Process};
use crate::body::Response;
use crate::rest::{
    self, Context, Refused,
    api::{Answer, Endpoint, Operation, Tag, schemas},
};

/// The format of Prometheus.
const CONTENT_TYPE: &str = "text/plain; version=0.0.4; charset=utf-8";

/// The path.
pub(in crate::ops) fn endpoint(metrics: Metrics, service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getMetrics",
        summary: "Metrics for Prometheus",
        about: "Counts, gauges and latencies of this process; never cached. docs/operations.md \
                explains them.",
        problems: vec![],
        example: "/metrics".into(),
        ..Operation::new(
            Tag::Operations,
            vec![Answer::file(
                "The metrics in Prometheus' text format.",
                CONTENT_TYPE,
                schemas::text,
            )],
        )
    };
    let state = (metrics, service);
    Endpoint::only("/metrics", state, operation, get)
}

async fn get(
    State((metrics, service)): State<(Metrics, Arc<Service>)>,
    _: Context,
) -> Result<Response, Refused> {
    let text = metrics.scrape(&service).await;
    Ok(rest::momentary(rest::file(text, CONTENT_TYPE)))
}

impl Metrics {
    /// All metrics as text.
    async fn scrape(&self, service: &Service) -> String {
        let mut families = self.registry.gather();
        families.extend(self.now(service).await.gather());
        // Only metrics without a name or a value are refused.
        TextEncoder::new()
            .encode_to_string(&families)
            .unwrap_or_default()
    }

    /// The figures that are read at each scrape, in a registry of their own: a table that is no longer loaded must not
    /// show.
    async fn now(&self, service: &Service) -> Registry {
        let now = Registry::new();
        let gauge = |name, help, labels: &[Label<'_>], value| {
            let gauge = Gauge::with_opts(labeled(name, help, labels));
            put(&now, gauge, |gauge| gauge.set(value));
        };
        let counter = |name, help, labels: &[Label<'_>], value| {
            let counter = Counter::with_opts(labeled(name, help, labels));
            put(&now, counter, |counter| counter.inc_by(value));
        };

        let cache = service.cache().await;
        for (name, help, value) in [
            (
                "strew_sampler_cache_hits_total",
                "Requested tables that were ready",
                cache.hits,
            ),
            (
                "strew_sampler_cache_misses_total",
                "Requested tables that had to be loaded",
                cache.misses,
            ),
            (
                "strew_table_loads_total",
                "Requested tables whose files were read for the request: those beyond tables.preload_bytes",
                cache.loads,
            ),
        ] {
            counter(name, help, &[], value as f64);
        }
        counter(
            "strew_work_moved_total",
            "Short work that took too long and went on as long work: its price was too low",
            &[],
            service.workers().moved() as f64,
        );
        let process = Process::now();
        if let Some(seconds) = process.cpu {
            counter(
                "process_cpu_seconds_total",
                "Processor time used",
                &[],
                seconds,
            );
        }
        let started = self.started.duration_since(UNIX_EPOCH).ok();
        for (name, help, value) in [
            (
                "strew_sampler_cache_bytes",
                "Memory of the tables that are ready",
                Some(cache.bytes as f64),
            ),
            (
                "strew_streams_in_flight",
                "Current answers with points",
                Some(service.streams().open() as f64),
            ),
            (
                "strew_streams_limit",
                "The most answers with points at once",
                Some(service.limits().max_streams as f64),
            ),
            (
                "strew_work_short_seconds_max",
                "The longest processor time of short work before it ended or became long work",
                Some(service.workers().longest_short().as_secs_f64()),
            ),
            (
                "strew_points_in_flight",
                "Points that current answers have announced and not made yet",
                Some(service.points_in_flight().get() as f64),
            ),
            (
                "process_resident_memory_bytes",
                "Resident memory",
                process.memory,
            ),
            ("process_threads", "Threads of the process", process.threads),
            ("process_open_fds", "Open files and sockets", process.files),
            (
                "process_start_time_seconds",
                "When the process began, in seconds since 1970",
                started.map(|since| since.as_secs_f64()),
            ),
        ] {
            if let Some(value) = value {
                gauge(name, help, &[], value);
            }
        }
        let catalog = service.catalog();
        for entry in catalog.entries().chain(catalog.in_space()) {
            let labels = [
                ("profile", &*entry.key.profile),
                ("alpha", &entry.key.alpha.to_string()),
                ("map", &entry.key.size.to_string()),
                ("digest", &entry.digest),
            ];
            gauge(
                "strew_table_info",
                "The tables that are loaded",
                &labels,
                1.0,
            );
        }
        let build = [
            ("version", env!("CARGO_PKG_VERSION")),
            (
                "revision",
                option_env!("STREW_BUILD_REVISION").unwrap_or("unknown"),
            ),
            ("algorithm", &strew_core::ALGORITHM_VERSION.to_string()),
        ];
        gauge("strew_build_info", "The program that runs", &build, 1.0);
        now
    }
}

/// A label and its value.
type Label<'a> = (&'static str, &'a str);

fn labeled(name: &str, help: &str, labels: &[Label<'_>]) -> Opts {
    let label = |&(name, value): &Label<'_>| (name.to_owned(), value.to_owned());
    Opts::new(name, help).const_labels(labels.iter().map(label).collect())
}

/// Adds a metric with its value. Of two equal names and labels the first stays.
fn put<M: Collector + Clone + 'static>(
    now: &Registry,
    metric: prometheus::Result<M>,
    set: impl Fn(&M),
) {
    if let Ok(metric) = metric {
        set(&metric);
        let _ = now.register(Box::new(metric));
    }
}
