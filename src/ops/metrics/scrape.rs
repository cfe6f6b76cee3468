//! `GET /metrics`: what was counted, and what is known only now.

use std::{fmt::Write as _, sync::Arc, time::UNIX_EPOCH};

use axum::{body::Body, extract::State, response::Response, routing};
use http::{HeaderValue, Method, header};

use super::{
    CACHE_BYTES, CACHE_HITS, CACHE_MISSES, FORGE_ENDED, FORGE_JOBS, MEMORY, MOST_STREAMS, Metrics,
    OPEN_FILES, POINTS_IN_FLIGHT, STARTED, STREAMS, TABLE_LOADS, THREADS, labels, process::Process,
};
use crate::{
    rest::api::{Answer, Endpoint, Operation, Tag, schemas},
    service::{Service, forging},
};

/// The format of Prometheus.
const CONTENT_TYPE: &str = "text/plain; version=0.0.4; charset=utf-8";

const CPU: &str = "process_cpu_seconds_total";

/// The path.
pub(in crate::ops) fn endpoint(metrics: Metrics, service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::GET,
        id: "getMetrics",
        summary: "Metrics for Prometheus",
        about: "Counts, gauges and latencies of this process; never cached. docs/operations.md tells \
                what they mean.",
        tag: Tag::Operations,
        path_parameters: &[],
        parameters: &[],
        body: None,
        answers: vec![Answer {
            status: 200,
            about: "The metrics in Prometheus' text format.",
            headers: vec![],
            contents: vec![(CONTENT_TYPE, schemas::text)],
        }],
        problems: vec![],
        example: "/metrics".into(),
    };
    let state = (metrics, service);
    Endpoint::new("/metrics", state, vec![(operation, routing::get(get))])
}

async fn get(State((metrics, service)): State<(Metrics, Arc<Service>)>) -> Response {
    let mut response = Response::new(Body::from(metrics.scrape(&service).await));
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(CONTENT_TYPE));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    response
}

impl Metrics {
    /// All metrics as text.
    async fn scrape(&self, service: &Service) -> String {
        let gauge = |name, value: Option<f64>| {
            if let Some(value) = value {
                self.gauge(name, vec![]).set(value);
            }
        };
        let cache = service.cache().await;
        self.counter(CACHE_HITS, vec![]).absolute(cache.hits);
        self.counter(CACHE_MISSES, vec![]).absolute(cache.misses);
        self.counter(TABLE_LOADS, vec![]).absolute(cache.loads);
        gauge(CACHE_BYTES, Some(cache.bytes as f64));
        let forge = service.forge_state();
        for (state, jobs) in [("queued", forge.queued), ("running", forge.running)] {
            let labels = labels([("state", state.into())]);
            self.gauge(FORGE_JOBS, labels).set(jobs as f64);
        }
        for (state, ended) in forging::State::ENDED.into_iter().zip(forge.ended) {
            let labels = labels([("outcome", state.name().into())]);
            self.counter(FORGE_ENDED, labels).absolute(ended);
        }
        gauge(STREAMS, Some(service.streams().open() as f64));
        let points = service.points_in_flight().get();
        gauge(POINTS_IN_FLIGHT, Some(points as f64));
        gauge(MOST_STREAMS, Some(service.limits().max_streams as f64));
        let process = Process::now();
        gauge(MEMORY, process.memory.map(|bytes| bytes as f64));
        gauge(THREADS, process.threads.map(|threads| threads as f64));
        gauge(OPEN_FILES, process.files.map(|files| files as f64));
        let started = self.inner.started.duration_since(UNIX_EPOCH);
        gauge(STARTED, started.ok().map(|since| since.as_secs_f64()));
        let mut text = self.inner.handle.render();
        if let Some(seconds) = process.cpu {
            // Counters of the registry are integers; this one is not.
            let _ = writeln!(
                text,
                "# HELP {CPU} Processor time used\n# TYPE {CPU} counter\n{CPU} {seconds}\n"
            );
        }
        text.push_str(&info(service));
        text
    }
}

/// What is loaded and what runs. Not of the registry, which keeps what was said once: a table that is
/// not loaded any more must not show.
fn info(service: &Service) -> String {
    let mut text = String::from(
        "# HELP strew_table_info The tables that are loaded\n# TYPE strew_table_info gauge\n",
    );
    for entry in service.catalog().entries() {
        let _ = writeln!(
            text,
            "strew_table_info{{profile=\"{}\",alpha=\"{}\",map=\"{}\",digest=\"{}\"}} 1",
            escaped(&entry.key.profile),
            escaped(&entry.key.alpha.to_string()),
            entry.key.size,
            escaped(&entry.digest),
        );
    }
    let revision = option_env!("STREW_BUILD_REVISION").unwrap_or("unknown");
    let _ = writeln!(
        text,
        "\n# HELP strew_build_info The program that runs\n# TYPE strew_build_info gauge\n\
         strew_build_info{{version=\"{}\",revision=\"{}\",algorithm=\"{}\"}} 1",
        env!("CARGO_PKG_VERSION"),
        escaped(revision),
        strew_core::ALGORITHM_VERSION,
    );
    text
}

/// A label's value.
fn escaped(text: &str) -> String {
    let text = text.replace('\\', "\\\\").replace('"', "\\\"");
    text.replace('\n', "\\n")
}
