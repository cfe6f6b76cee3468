//! Settings of work: limits of queries and of memory, threads, when files are read again.

use serde::{Deserialize, Serialize};

/// The most that a query may request, and that answers may hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    pub memory_bytes: u64,
    pub max_points: u64,
    pub max_rows: u64,
    pub max_vertices: usize,
    pub max_body_bytes: usize,
    pub max_requests: usize,
    pub max_bytes_in_flight: usize,
    pub max_streams: usize,
    pub block_bytes: usize,
    pub cache_bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            memory_bytes: 0,
            max_points: 2_000_000_000,
            max_rows: 5_000_000,
            max_vertices: 100_000,
            max_body_bytes: 4 << 20,
            max_requests: 1024,
            max_bytes_in_flight: 1 << 30,
            max_streams: 256,
            block_bytes: 256 << 10,
            cache_bytes: 64 << 20,
        }
    }
}

impl Limits {
    /// The bytes of one answer and one query of the largest size, which have to fit.
    pub(super) const fn least_bytes(&self) -> usize {
        4 * self.block_bytes + (19 << 20) + self.max_body_bytes
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reload {
    pub watch_seconds: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Workers {
    pub threads: usize,
}
