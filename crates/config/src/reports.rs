//! Settings of answers and reports: HTTP, the log, metrics, spans.

use std::{net::Ipv6Addr, path::PathBuf};

use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Http {
    pub cors_origins: String,
    pub cache_seconds: u32,
    pub public_url: String,
}

impl Http {
    pub(crate) fn origins(&self) -> impl Iterator<Item = &str> {
        let parts = self.cors_origins.split([' ', ',']);
        parts.filter(|origin| !origin.is_empty())
    }

    pub(super) fn faults(&self) -> Vec<String> {
        let mut faults = vec![];
        let origins = &self.cors_origins;
        let wrong = self.origins().find(|origin| !is_origin(origin));
        if let Some(origin) = wrong.filter(|_| origins.trim() != "*") {
            faults.push(format!(
                "http.cors_origins = {origins:?}: {origin:?} is not an origin; allowed: * or origins \
                 such as https://a.example and http://localhost:3000, with spaces or commas between them"
            ));
        }
        let url = &self.public_url;
        if !url.is_empty() && !is_web_address(url) {
            faults.push(format!(
                "http.public_url = {url:?} is not allowed; allowed: \"\" or an address such as \
                 https://points.example or http://points.example:8080, without a path"
            ));
        }
        faults
    }
}

/// Whether a text is an origin as browsers send it: a scheme, a host, perhaps a port.
fn is_origin(text: &str) -> bool {
    let Some((scheme, authority)) = text.split_once("://") else {
        return false;
    };
    let is_scheme = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
    let is_host = |c: char| c.is_ascii_alphanumeric() || "-._[]:".contains(c);
    !scheme.is_empty()
        && scheme.chars().all(is_scheme)
        && !authority.is_empty()
        && authority.chars().all(is_host)
}

/// Whether a text is the address of a host on the web, perhaps with a port, and nothing else.
fn is_web_address(text: &str) -> bool {
    let stripped = ["http://", "https://"].map(|scheme| text.strip_prefix(scheme));
    let Some(authority) = stripped.into_iter().flatten().next() else {
        return false;
    };
    let (host, port) = match authority.rsplit_once(':') {
        Some((host, port)) if !port.ends_with(']') => (host, Some(port)),
        _ => (authority, None),
    };
    let is_port = |port: &str| {
        port.bytes().all(|b| b.is_ascii_digit()) && port.parse::<u16>().is_ok_and(|port| port > 0)
    };
    let is_label = |label: &str| {
        let is_plain = |b: u8| b.is_ascii_alphanumeric() || b == b'-';
        let has_ends = !label.starts_with('-') && !label.ends_with('-');
        has_ends && !label.is_empty() && label.bytes().all(is_plain)
    };
    let open = host.strip_prefix('[');
    let inner = open.and_then(|host| host.strip_suffix(']'));
    let is_host = match inner {
        Some(inner) => inner.parse::<Ipv6Addr>().is_ok(),
        None => host.split('.').all(is_label),
    };
    is_host && port.is_none_or(is_port)
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Log {
    pub filter: String,
    pub format: LogFormat,
    pub output: LogOutput,
}

impl Log {
    pub(super) fn fault(&self) -> Option<String> {
        let filter = &self.filter;
        let error = wrong_filter(filter)?;
        Some(format!(
            "log.filter = {filter:?}; allowed: a level (error, warn, info, debug, trace) or levels \
             by module (info,strew=debug): {error}"
        ))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LogFormat {
    Text,
    /// An object a line.
    Json,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LogOutput {
    /// Standard error; standard output has the address that the daemon listens on.
    Stderr,
    Stdout,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Metrics {
    pub enabled: bool,
}

/// The settings of spans: the collector that receives them, if any.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Telemetry {
    pub otlp_endpoint: String,
    pub otlp_ca: PathBuf,
    pub service_name: String,
    pub sample_ratio: f64,
    pub max_queued_spans: usize,
    pub export_timeout_seconds: f64,
}

impl Telemetry {
    /// The fault of the address, if it has one.
    pub(super) fn fault(&self) -> Option<String> {
        let endpoint = &self.otlp_endpoint;
        if endpoint.is_empty() {
            return None;
        }
        if !is_endpoint(endpoint) {
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

    pub fn is_https(&self) -> bool {
        self.otlp_endpoint.starts_with("https:")
    }
}

/// Why a text is no filter of the log.
#[cfg(feature = "log")]
fn wrong_filter(text: &str) -> Option<String> {
    use tracing_subscriber::filter::{LevelFilter, Targets};
    // A word alone is a level: `Targets` takes a mistyped one for a module, and nothing is logged.
    let mut words = text.split(',').filter(|part| !part.contains('='));
    let mistyped = words.find_map(|word| word.trim().parse::<LevelFilter>().err());
    let wrong = text.parse::<Targets>().err().map(|error| error.to_string());
    mistyped.map(|error| error.to_string()).or(wrong)
}

/// Programs without a log need no parser of filters.
#[cfg(not(feature = "log"))]
const fn wrong_filter(_: &str) -> Option<String> {
    None
}

/// Whether a text is the address of a collector: a scheme and an authority.
fn is_endpoint(text: &str) -> bool {
    let mut schemes = ["http://", "https://"].into_iter();
    let rest = schemes.find_map(|scheme| text.strip_prefix(scheme));
    let authority = rest.map(|rest| rest.strip_suffix('/').unwrap_or(rest));
    authority.is_some_and(|authority| {
        let is_allowed = |c: char| c.is_ascii_alphanumeric() || "-._~%!$&'()*+,;=:@[]".contains(c);
        !authority.is_empty() && authority.chars().all(is_allowed)
    })
}

#[cfg(test)]
mod tests {
    use super::is_web_address;

    #[test]
    fn web_addresses_have_a_host_and_perhaps_a_port() {
        for good in [
            "https://points.example",
            "http://localhost:8080",
            "http://127.0.0.1:1",
            "https://[::1]:65535",
            "https://[2001:db8::1]",
        ] {
            assert!(is_web_address(good), "{good}");
        }
        for wrong in [
            "http://:",
            "http://",
            "https://a..b",
            "https://a:b:c",
            "https://[::1",
            "https://-",
            "https://a.example:99999",
            "https://a.example:0",
            "https://a.example:+1",
            "https://a.example/",
            "ftp://a.example",
            "a.example",
            "https://a b",
            "https://u@a.example",
            "https://a.example?x",
            "https://a\"b",
        ] {
            assert!(!is_web_address(wrong), "{wrong}");
        }
    }
}
