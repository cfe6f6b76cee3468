//! `GET /metrics`: the counters, and the figures of the moment: of the service, and on Linux of the process.

use std::{fs, sync::Arc, time::UNIX_EPOCH};

use axum::extract::State;
use prometheus::{Counter, Gauge, Opts, Registry, TextEncoder, core::Collector};
use strew_service::Service;

use super::Metrics;
use crate::rest::{
    self, Context,
    api::{Answer, Endpoint, Operation, Tag, schemas},
};

const CONTENT_TYPE: &str = "text/plain; version=0.0.4; charset=utf-8";

pub(in crate::ops) fn endpoint(metrics: Metrics, service: Arc<Service>) -> Endpoint {
    let answer = "The metrics in Prometheus' text format.";
    let answers = vec![Answer::file(answer, CONTENT_TYPE, schemas::text)];
    let operation = Operation {
        id: "getMetrics",
        summary: "Metrics for Prometheus",
        about: "Counts, gauges and latencies of this process; never cached. docs/operations.md \
                explains them.",
        problems: vec![],
        ..Operation::new(Tag::Operations, answers)
    };
    let get = async |State((metrics, service)): State<(Metrics, Arc<Service>)>, _: Context| {
        rest::momentary(rest::file(metrics.scrape(&service).await, CONTENT_TYPE))
    };
    Endpoint::only("/metrics", (metrics, service), operation, get)
}

impl Metrics {
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
        let put = |name: &str, help: &str, labels: &[(&str, &str)], value: f64| {
            let mut opts = Opts::new(name, help);
            for (name, value) in labels {
                opts = opts.const_label(*name, *value);
            }
            let metric: prometheus::Result<Box<dyn Collector>> = match name.ends_with("_total") {
                true => Counter::with_opts(opts).map(|counter| {
                    counter.inc_by(value);
                    Box::new(counter) as _
                }),
                false => Gauge::with_opts(opts).map(|gauge| {
                    gauge.set(value);
                    Box::new(gauge) as _
                }),
            };
            // Of two equal names and labels the first stays.
            let _ = metric.and_then(|metric| now.register(metric));
        };
        let (cache, workers, process) = (service.cache().await, service.workers(), Process::now());
        let started = self.started.duration_since(UNIX_EPOCH).ok();
        let figures = [
            (
                "strew_sampler_cache_hits_total",
                "Requested tables that were ready",
                Some(cache.hits as f64),
            ),
            (
                "strew_sampler_cache_misses_total",
                "Requested tables that had to be loaded",
                Some(cache.misses as f64),
            ),
            (
                "strew_table_loads_total",
                "Requested tables whose files were read for the request: those beyond tables.preload_bytes",
                Some(cache.loads as f64),
            ),
            (
                "strew_work_moved_total",
                "Short work that took too long and went on as long work: its price was too low",
                Some(workers.moved() as f64),
            ),
            (
                "process_cpu_seconds_total",
                "Processor time used",
                process.cpu,
            ),
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
                Some(workers.longest_short().as_secs_f64()),
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
        ];
        for (name, help, value) in figures {
            if let Some(value) = value {
                put(name, help, &[], value);
            }
        }
        let catalog = service.catalog();
        for entry in catalog.entries().chain(catalog.in_space()) {
            let (alpha, size) = (entry.key.alpha.to_string(), entry.key.size.to_string());
            let labels = [
                ("profile", &*entry.key.profile),
                ("alpha", &alpha),
                ("map", &size),
                ("digest", &entry.digest),
            ];
            put(
                "strew_table_info",
                "The tables that are loaded",
                &labels,
                1.0,
            );
        }
        let revision = option_env!("STREW_BUILD_REVISION").unwrap_or("unknown");
        let build = [
            ("version", env!("CARGO_PKG_VERSION")),
            ("revision", revision),
            ("algorithm", &strew_core::ALGORITHM_VERSION.to_string()),
        ];
        put("strew_build_info", "The program that runs", &build, 1.0);
        now
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Process {
    /// Resident memory in bytes.
    memory: Option<f64>,
    /// Processor time in seconds.
    cpu: Option<f64>,
    threads: Option<f64>,
    files: Option<f64>,
}

/// Ticks per second in `/proc`, on every Linux that Rust supports.
const TICKS: f64 = 100.0;

impl Process {
    fn now() -> Self {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        Self {
            memory: of(&status, MEMORY).map(|kibibytes| kibibytes * 1024.0),
            cpu: cpu(),
            threads: of(&status, "Threads:"),
            files: fs::read_dir("/proc/self/fd")
                .ok()
                .map(|all| all.count() as f64),
        }
    }
}

/// Resident memory in bytes; 0 where it is not known.
pub(in crate::ops) fn resident() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    of(&status, MEMORY).map_or(0, |kibibytes| kibibytes as u64 * 1024)
}

/// The line of resident memory, in KiB.
const MEMORY: &str = "VmRSS:";

fn of(status: &str, name: &str) -> Option<f64> {
    let rest = status.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_whitespace().next()?.parse().ok()
}

fn cpu() -> Option<f64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program comes first, in parentheses, and may hold blanks.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |at: usize| -> Option<f64> { fields.get(at)?.parse().ok() };
    Some((ticks(11)? + ticks(12)?) / TICKS)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn figures_are_read() {
        let now = Process::now();
        assert!(now.memory.is_some_and(|bytes| bytes > 1e6));
        assert!(now.threads.is_some_and(|threads| threads > 0.0));
        assert!(now.files.is_some_and(|files| files > 2.0));
        assert!(now.cpu.is_some());
    }
}
