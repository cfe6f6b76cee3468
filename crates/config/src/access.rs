//! Settings of access: who is let in, and how much each client may take.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Limits, NETWORKS, Networks, range::out_of_range};

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Access {
    /// A file with keys; empty for none.
    pub keys_file: PathBuf,
    /// Keys in the same form as in the file; empty for none.
    pub keys: String,
    /// Whether clients without a key are admitted although there are keys.
    pub anonymous: bool,
    /// The proxies whose `X-Forwarded-For` is trusted.
    pub trusted_proxies: String,
}

impl Access {
    /// The file with keys, if there is one.
    pub fn keys_file(&self) -> Option<&Path> {
        Some(self.keys_file.as_path()).filter(|file| !file.as_os_str().is_empty())
    }

    pub fn has_keys(&self) -> bool {
        self.keys_file().is_some() || !self.keys.is_empty()
    }

    /// Whether only clients with a key are admitted.
    pub fn needs_key(&self) -> bool {
        self.has_keys() && !self.anonymous
    }

    pub(super) fn faults(&self) -> Vec<String> {
        let proxies = &self.trusted_proxies;
        let fault = Networks::read(proxies).err().map(|part| {
            format!(
                "access.trusted_proxies = {proxies:?}: {part:?} is not one; allowed: {NETWORKS}"
            )
        });
        fault.into_iter().collect()
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rate {
    /// Points per second; 0 for no limit.
    pub points_per_second: f64,
    /// The burst allowed after a pause; 0 means ten seconds' worth.
    pub burst_points: f64,
    pub max_clients: usize,
}

impl Rate {
    pub(super) fn faults(&self) -> Vec<String> {
        out_of_range!(self, "rate",
            points_per_second: 0.0..=1e15,
            burst_points: 0.0..=1e15,
            max_clients: 64.0..=1e7,
        )
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AddressLimits {
    pub max_connections: usize,
    /// Requests, from their head to the last byte of the answer.
    pub max_requests: usize,
    pub max_streams: usize,
    /// Bytes that its requests and answers hold.
    pub max_bytes_in_flight: usize,
}

impl AddressLimits {
    pub(super) fn faults(&self, limits: &Limits) -> Vec<String> {
        out_of_range!(self, "per_address",
            max_connections: 1.0..=1e6,
            max_requests: 1.0..=1e6,
            max_streams: 1.0..=1e6,
            max_bytes_in_flight: limits.least_bytes() as f64..=1e15,
        )
    }
}
