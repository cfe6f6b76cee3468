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
    pub max_connections: usize,
    pub header_read_timeout_seconds: f64,
    pub max_header_bytes: u32,
    pub max_requests_per_connection: u32,
    pub http2_keepalive_seconds: f64,
    pub idle_connection_seconds: f64,
    pub body_read_timeout_seconds: f64,
    pub first_byte_seconds: f64,
    pub ready_within_seconds: f64,
    pub max_stream_seconds: f64,
    pub stalled_reader_seconds: f64,
    pub min_bytes_per_second: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Admin {
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
    pub certificate: PathBuf,
    pub key: PathBuf,
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
    pub notice_seconds: f64,
    pub drain_seconds: f64,
}
