//! Settings of layers, read at the start and again, and checked: the ranges of all numbers, and the rules of sections,
//! which stand beside their fields.

use std::path::PathBuf;

use super::{Config, ConfigError, Layers};

const SECOND: f64 = 1.0;
const HOUR: f64 = 3600.0;
const DAY: f64 = 86_400.0;

/// The faults of numbers: `out_of_range!(config, server.max_connections: 1.0..=1e6)`.
macro_rules! out_of_range {
    ($config:expr, $($section:ident.$field:ident: $range:expr,)+) => {
        [$((
            concat!(stringify!($section), ".", stringify!($field)),
            $config.$section.$field as f64,
            $range,
        )),+]
        .into_iter()
        .filter(|(_, value, range)| !range.contains(value))
        .map(|(key, value, range)| {
            format!("{key} = {value}; allowed: {} to {}", range.start(), range.end())
        })
    };
}

impl Layers {
    pub fn finish(self) -> Result<Config, ConfigError> {
        let read: Result<Config, _> = self.merged.clone().try_into();
        let mut config = read.map_err(|error| ConfigError::Invalid(Box::new(error)))?;
        validate(&config)?;
        config.layers = self;
        Ok(config)
    }
}

impl Config {
    /// Reads the files again. The fields, lists and worlds that they name now are taken; of the other settings, which stay
    /// as they were at the start, also returns the names of those that the next start would change.
    pub fn read_again(&self) -> Result<(Self, Vec<String>), ConfigError> {
        let then = &self.layers;
        let over = |layers: Layers, file: &PathBuf| layers.file(file);
        let mut now = then.files.iter().try_fold(Layers::new()?, over)?;
        for [key, text, source] in &then.set {
            now = now.set_text(key, text, source)?;
        }
        let is_other = |key: &String| now.value(key) != then.value(key);
        let changed = now.keys().into_iter().filter(is_other).collect();
        let (mut after, now) = (self.clone(), now.finish()?);
        after.fields.named = now.fields.named;
        after.except.named = now.except.named;
        after.worlds.named = now.worlds.named;
        Ok((after, changed))
    }
}

/// Checks every setting; reports all that are not allowed.
pub(super) fn validate(config: &Config) -> Result<(), ConfigError> {
    let least_bytes = config.limits.least_bytes() as f64;
    let numbers = out_of_range!(config,
        server.max_connections: 1.0..=1e6,
        server.header_read_timeout_seconds: 0.1 * SECOND..=HOUR,
        // Below 8192 the HTTP library refuses; 16 MiB a connection is more than any head needs.
        server.max_header_bytes: 8192.0..=f64::from(16 << 20),
        server.max_requests_per_connection: 1.0..=1e6,
        server.http2_keepalive_seconds: SECOND..=HOUR,
        server.idle_connection_seconds: 0.1 * SECOND..=DAY,
        server.body_read_timeout_seconds: 0.1 * SECOND..=HOUR,
        server.first_byte_seconds: 0.1 * SECOND..=HOUR,
        server.ready_within_seconds: 0.1 * SECOND..=HOUR,
        server.max_stream_seconds: 0.1 * SECOND..=365.0 * DAY,
        server.stalled_reader_seconds: 0.1 * SECOND..=DAY,
        server.min_bytes_per_second: 0.0..=1e9,
        rate.points_per_second: 0.0..=1e15,
        rate.burst_points: 0.0..=1e15,
        rate.max_clients: 64.0..=1e7,
        http.cache_seconds: 0.0..=365.0 * DAY,
        limits.memory_bytes: 0.0..=1e15,
        limits.max_points: 1.0..=1e15,
        limits.max_rows: 1.0..=1e12,
        limits.max_vertices: 3.0..=1e8,
        limits.max_body_bytes: 1024.0..=f64::from(1 << 30),
        limits.max_requests: 1.0..=1e6,
        limits.max_bytes_in_flight: least_bytes..=1e15,
        limits.max_streams: 1.0..=1e6,
        // gRPC clients refuse messages above 4 MiB, and ours stay below 1 MiB.
        limits.block_bytes: 4096.0..=f64::from(512 << 10),
        limits.cache_bytes: 0.0..=1e15,
        per_address.max_connections: 1.0..=1e6,
        per_address.max_requests: 1.0..=1e6,
        per_address.max_streams: 1.0..=1e6,
        per_address.max_bytes_in_flight: least_bytes..=1e15,
        workers.threads: 0.0..=1024.0,
        shutdown.notice_seconds: 0.0..=DAY,
        shutdown.drain_seconds: 0.0..=DAY,
        telemetry.sample_ratio: 0.0..=1.0,
        telemetry.max_queued_spans: 1.0..=1e6,
        telemetry.export_timeout_seconds: 0.1 * SECOND..=HOUR,
        reload.watch_seconds: 0.0..=DAY,
        except.max_ids: 0.0..=1e8,
    );
    let rules = [
        config.tls.fault(),
        config.access.fault(),
        config.admin.fault(),
        config.log.fault(),
        config.telemetry.fault(),
    ];
    let faults = numbers
        .chain(rules.into_iter().flatten())
        .chain(config.http.faults());
    let faults: Vec<String> = faults.collect();
    match faults.is_empty() {
        true => Ok(()),
        false => Err(ConfigError::OutOfRange { faults }),
    }
}
