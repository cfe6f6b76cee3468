//! Settings of connections: where to serve, TLS, administrators, stopping.

use std::{
    net::SocketAddr,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use super::{
    listen,
    range::{DAY, HOUR, SECOND, out_of_range},
};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Server {
    #[serde(deserialize_with = "listen::deserialize")]
    pub listen: SocketAddr,
    /// The most connections at once.
    pub max_connections: usize,
    /// How long the head of an HTTP/1.1 request may take, in seconds.
    pub header_read_timeout_seconds: f64,
    /// The most bytes of a request's head.
    pub max_header_bytes: u32,
    /// The most requests at once on one HTTP/2 connection.
    pub max_requests_per_connection: u32,
    /// The time between pings on a quiet HTTP/2 connection, and for a reply, in seconds.
    pub http2_keepalive_seconds: f64,
    /// How long an HTTP/2 connection may be without a request, in seconds.
    pub idle_connection_seconds: f64,
    /// How long the body of a request may take, in seconds.
    pub body_read_timeout_seconds: f64,
    /// How long the head of an answer may take once its request is there, in seconds.
    pub first_byte_seconds: f64,
    /// How long short work may wait for a worker before the daemon is not ready, in seconds.
    pub ready_within_seconds: f64,
    /// How long an answer may take in all, in seconds.
    pub max_stream_seconds: f64,
    /// How long a reader may take nothing of what waits for it, in seconds.
    pub stalled_reader_seconds: f64,
    /// The least rate at which a reader must take an answer that lasts longer than that.
    pub min_bytes_per_second: f64,
}

impl Server {
    pub(super) fn faults(&self) -> Vec<String> {
        out_of_range!(self, "server",
            max_connections: 1.0..=1e6,
            header_read_timeout_seconds: 0.1 * SECOND..=HOUR,
            // Below 8192 the HTTP library refuses; 16 MiB a connection is more than any head needs.
            max_header_bytes: 8192.0..=f64::from(16 << 20),
            max_requests_per_connection: 1.0..=1e6,
            http2_keepalive_seconds: SECOND..=HOUR,
            idle_connection_seconds: 0.1 * SECOND..=DAY,
            body_read_timeout_seconds: 0.1 * SECOND..=HOUR,
            first_byte_seconds: 0.1 * SECOND..=HOUR,
            ready_within_seconds: 0.1 * SECOND..=HOUR,
            max_stream_seconds: 0.1 * SECOND..=365.0 * DAY,
            stalled_reader_seconds: 0.1 * SECOND..=DAY,
            min_bytes_per_second: 0.0..=1e9,
        )
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Admin {
    /// Address and port; empty for none.
    pub listen: String,
}

impl Admin {
    /// The address, if there is one.
    pub fn address(&self) -> Result<Option<SocketAddr>, String> {
        let text = Some(self.listen.as_str()).filter(|text| !text.is_empty());
        text.map(listen::read).transpose()
    }

    pub(super) fn faults(&self) -> Vec<String> {
        let error = self.address().err();
        let fault = error.map(|error| format!("admin.listen: {error}, or nothing"));
        fault.into_iter().collect()
    }
}

/// The certificates, if any.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tls {
    /// A PEM file with the server's certificate and those that vouch for it; empty for no TLS.
    pub certificate: PathBuf,
    pub key: PathBuf,
    /// A PEM file with the authorities that vouch for clients; empty if clients need not prove who
    /// they are.
    pub client_ca: PathBuf,
}

impl Tls {
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let all = [&self.certificate, &self.key, &self.client_ca];
        all.into_iter()
            .map(PathBuf::as_path)
            .filter(|path| !path.as_os_str().is_empty())
    }

    pub fn is_on(&self) -> bool {
        !self.certificate.as_os_str().is_empty()
    }

    pub(super) fn faults(&self) -> Vec<String> {
        let Self {
            certificate,
            key,
            client_ca,
        } = self;
        let [has_certificate, has_key, has_clients] =
            [certificate, key, client_ca].map(|path| !path.as_os_str().is_empty());
        if has_certificate == has_key && (has_key || !has_clients) {
            return vec![];
        }
        vec![format!(
            "tls.certificate = {certificate:?}, tls.key = {key:?}, tls.client_ca = {client_ca:?}; \
             allowed: none of them, the first two, or all"
        )]
    }

    pub fn proves_clients(&self) -> bool {
        self.is_on() && !self.client_ca.as_os_str().is_empty()
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shutdown {
    /// How long the daemon still takes requests after `/readyz` fails, in seconds.
    pub notice_seconds: f64,
    /// How long open streams may then go on, in seconds.
    pub drain_seconds: f64,
}

impl Shutdown {
    pub(super) fn faults(&self) -> Vec<String> {
        out_of_range!(self, "shutdown",
            notice_seconds: 0.0..=DAY,
            drain_seconds: 0.0..=DAY,
        )
    }
}
