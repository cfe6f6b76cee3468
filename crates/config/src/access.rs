//! Settings of access: who is let in, and how much each client may take.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{NETWORKS, Networks, loaded::some};

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Access {
    pub keys_file: PathBuf,
    pub keys: String,
    pub anonymous: bool,
    pub trusted_proxies: String,
}

impl Access {
    /// The file with keys, if there is one.
    pub fn keys_file(&self) -> Option<&Path> {
        some(&self.keys_file)
    }

    pub fn has_keys(&self) -> bool {
        self.keys_file().is_some() || !self.keys.is_empty()
    }

    /// Whether only clients with a key are admitted.
    pub fn needs_key(&self) -> bool {
        self.has_keys() && !self.anonymous
    }

    pub(super) fn fault(&self) -> Option<String> {
        let proxies = &self.trusted_proxies;
        let part = Networks::read(proxies).err()?;
        Some(format!(
            "access.trusted_proxies = {proxies:?}: {part:?} is not one; allowed: {NETWORKS}"
        ))
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rate {
    pub points_per_second: f64,
    pub burst_points: f64,
    pub max_clients: usize,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AddressLimits {
    pub max_connections: usize,
    pub max_requests: usize,
    pub max_streams: usize,
    pub max_bytes_in_flight: usize,
}
