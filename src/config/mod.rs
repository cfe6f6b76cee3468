//! Settings: every one has a default in `config/strew.toml`, a meaning there, and a range here.
//!
//! Layers, the later the stronger: defaults, a file, the environment, flags. They are merged as
//! TOML by `layers` and read into [`Config`] once; what is read is checked as a whole, and from
//! then on nobody checks a setting again.

mod layers;
mod validate;

use std::{
    net::SocketAddr,
    path::{Path, PathBuf},
    time::Duration,
};

use serde::{Deserialize, Serialize};

use crate::{
    access,
    ops::{spans, telemetry, tls},
    rest,
    service::Limits,
};

pub use layers::{ConfigError, Layers};

/// The defaults, with comments.
pub const DEFAULTS: &str = include_str!("../../config/strew.toml");

/// All settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Where and how to serve.
    pub server: Server,
    /// How to prove who serves and who asks.
    pub tls: tls::Settings,
    /// Who is let in.
    pub access: access::Settings,
    /// How fast points may be taken.
    pub rate: access::RateSettings,
    /// Where administrators are let in.
    pub admin: Admin,
    /// How HTTP answers.
    pub http: rest::Settings,
    /// Which tables to load.
    pub tables: Tables,
    /// What a query may ask for.
    pub limits: Limits,
    /// What one address may use.
    pub per_address: AddressLimits,
    /// When files are read again.
    pub reload: Reload,
    /// Who makes points.
    pub workers: Workers,
    /// How to stop.
    pub shutdown: Shutdown,
    /// What to log.
    pub log: Log,
    /// What to count.
    pub metrics: Metrics,
    /// Where to send spans.
    pub telemetry: spans::Settings,
}

/// Where and how to serve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Server {
    /// Address and port.
    pub listen: SocketAddr,
    /// The most connections at once.
    pub max_connections: usize,
    /// How long the head of an HTTP/1.1 request may take, in seconds.
    pub header_read_timeout_seconds: f64,
    /// The most bytes of a request's head.
    pub max_header_bytes: u32,
    /// The most requests at once on one HTTP/2 connection.
    pub max_requests_per_connection: u32,
    /// How often a quiet HTTP/2 client is asked for a sign of life, and how long it may take, in
    /// seconds.
    pub http2_keepalive_seconds: f64,
    /// How long an HTTP/2 connection may be without a request, in seconds.
    pub idle_connection_seconds: f64,
    /// How long the body of a request may take, in seconds.
    pub body_read_timeout_seconds: f64,
    /// How long the head of an answer may take once its request is there, in seconds.
    pub first_byte_seconds: f64,
    /// How long an answer may take in all, in seconds.
    pub max_stream_seconds: f64,
    /// How long a reader may take nothing of what waits for it, in seconds.
    pub stalled_reader_seconds: f64,
    /// The least rate at which a reader must take an answer that lasts longer than that.
    pub min_bytes_per_second: f64,
}

/// What one address may use at once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AddressLimits {
    /// Connections.
    pub max_connections: usize,
    /// Requests, from their head to the last byte of the answer.
    pub max_requests: usize,
    /// Answers with points.
    pub max_streams: usize,
    /// Bytes that its requests and answers hold.
    pub max_bytes_in_flight: usize,
}

/// Where administrators are let in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Admin {
    /// Address and port; empty for none.
    pub listen: String,
}

impl Admin {
    /// The address, if there is one.
    ///
    /// # Errors
    /// If it does not read as one.
    pub fn address(&self) -> Result<Option<SocketAddr>, std::net::AddrParseError> {
        let text = Some(self.listen.as_str()).filter(|text| !text.is_empty());
        text.map(str::parse).transpose()
    }
}

/// Which tables to load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tables {
    /// Whether the built-in ones are loaded.
    pub embedded: bool,
    /// A folder with more; empty for none.
    pub folder: PathBuf,
}

impl Tables {
    /// The folder, if there is one.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        Some(self.folder.as_path()).filter(|folder| !folder.as_os_str().is_empty())
    }
}

/// When files are read again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reload {
    /// The time between two looks at the files, in seconds; 0 for never.
    pub watch_seconds: f64,
}

/// Who makes points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Workers {
    /// Threads that make points; 0 for one per core.
    pub threads: usize,
}

/// How to stop.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shutdown {
    /// How long requests are still taken after `/readyz` says no, in seconds.
    pub notice_seconds: f64,
    /// How long open streams may then go on, in seconds.
    pub drain_seconds: f64,
}

/// What to log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Log {
    /// A level, or levels by module.
    pub filter: String,
    /// How a line looks.
    pub format: telemetry::Format,
}

/// What to count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Metrics {
    /// Whether `/metrics` is served.
    pub enabled: bool,
}

impl Config {
    /// The merged settings as TOML.
    ///
    /// # Errors
    /// Only if a path is not Unicode.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string_pretty(self)
    }
}

/// Seconds of a setting as a duration; settings are checked to be within range before.
pub(crate) fn seconds(value: f64) -> Duration {
    Duration::try_from_secs_f64(value).unwrap_or(Duration::MAX)
}
