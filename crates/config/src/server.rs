//! Settings of connections: where to serve, TLS, administrators, stopping.

use std::{
    net::SocketAddr,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use super::listen;

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

    pub(super) fn fault(&self) -> Option<String> {
        let error = self.address().err()?;
        Some(format!("admin.listen: {error}, or nothing"))
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

    pub(super) fn fault(&self) -> Option<String> {
        let all = [&self.certificate, &self.key, &self.client_ca];
        let [certificate, key, clients] = all.map(|path| !path.as_os_str().is_empty());
        let [a, b, c] = all;
        (certificate != key || clients && !key).then(|| {
            format!(
                "tls.certificate = {a:?}, tls.key = {b:?}, tls.client_ca = {c:?}; allowed: none of \
                 them, the first two, or all"
            )
        })
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
