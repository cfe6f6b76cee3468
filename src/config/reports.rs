//! Settings of answers and reports: HTTP, the log, metrics, spans.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// How HTTP answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Http {
    /// The origins of pages that may send requests: `*` for all, or origins separated by spaces or
    /// commas.
    pub cors_origins: String,
    /// How long an answer may be kept that a restart with other tables could change, in seconds.
    pub cache_seconds: u32,
}

impl Http {
    /// The parts of the list of origins.
    pub(crate) fn origins(&self) -> impl Iterator<Item = &str> {
        let parts = self.cors_origins.split([' ', ',']);
        parts.filter(|origin| !origin.is_empty())
    }
}

/// What to log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Log {
    /// A level, or levels by module.
    pub filter: String,
    /// How a line looks.
    pub format: LogFormat,
}

/// How a line of the log looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LogFormat {
    /// For people.
    Text,
    /// An object a line.
    Json,
}

/// What to count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Metrics {
    /// Whether `/metrics` is served.
    pub enabled: bool,
}

/// Where spans go, if anywhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Telemetry {
    /// The collector's address; empty for none.
    pub otlp_endpoint: String,
    /// A PEM file with the authorities that vouch for the collector, for `https`.
    pub otlp_ca: PathBuf,
    /// What the daemon is called there.
    pub service_name: String,
    /// The share of requests without a trace of their own that begin one.
    pub sample_ratio: f64,
    /// The most spans that wait to be sent.
    pub max_queued_spans: usize,
    /// How long sending may take, in seconds.
    pub export_timeout_seconds: f64,
}

impl Telemetry {
    /// What is wrong with the address, if there is one.
    pub(crate) fn fault(&self) -> Option<String> {
        let endpoint = &self.otlp_endpoint;
        if endpoint.is_empty() {
            return None;
        }
        let read = endpoint.parse::<http::Uri>().ok();
        let is_whole = read.is_some_and(|uri| {
            matches!(uri.scheme_str(), Some("http" | "https"))
                && uri.authority().is_some()
                && uri.path_and_query().is_none_or(|path| path == "/")
        });
        if !is_whole {
            return Some(format!(
                "telemetry.otlp_endpoint = {endpoint:?}; allowed: http://host:port, https://host:port, or \
                 nothing"
            ));
        }
        let has_ca = !self.otlp_ca.as_os_str().is_empty();
        (self.is_https() != has_ca).then(|| {
            format!(
                "telemetry.otlp_endpoint = {endpoint:?}, telemetry.otlp_ca = {:?}; allowed: an authority \
                 with https, and none with http",
                self.otlp_ca
            )
        })
    }

    /// Whether spans are sent by TLS.
    pub(crate) fn is_https(&self) -> bool {
        self.otlp_endpoint.starts_with("https:")
    }
}
