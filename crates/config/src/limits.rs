//! Settings of work: limits of queries and of memory, threads, when files are read again.

use serde::{Deserialize, Serialize};

/// The most that a query may request, and that answers may hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The memory that the other limits are fitted to, in bytes; 0 for that of the container or the machine.
    pub memory_bytes: u64,
    /// The most points of one answer. Keeps a slip of a zero from filling a disk; the refusal says
    /// the exact count.
    pub max_points: u64,
    /// The most lattice rows that are counted one by one, where a region is not a box or is warped
    /// (about three for each mean spacing of its outline's width and height, and of its height), and
    /// points that keep clear of others. They take about a microsecond each before the first point.
    pub max_rows: u64,
    /// The most vertices that the polygons of a query have in all: bounds its memory.
    pub max_vertices: usize,
    /// The most bytes of a body or a message: bounds the memory of each before it is read.
    pub max_body_bytes: usize,
    /// The most requests that are being answered at once: read, counted, planned. Bounds what waits
    /// for the workers.
    pub max_requests: usize,
    /// The most bytes that requests and answers hold at once: bodies received, answers not yet
    /// sent, and the buffers of streams.
    pub max_bytes_in_flight: usize,
    /// The most answers with points at once. Bounds memory: an answer holds 1 to 3 MB,
    /// some blocks and the rows they are made of, and a picture up to 16 MB more.
    pub max_streams: usize,
    /// The size of a block before it is encoded, in bytes.
    pub block_bytes: usize,
    /// The most memory for samplers that are ready to answer, in bytes.
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
    /// The time between two checks of the files, in seconds; 0 for never.
    pub watch_seconds: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Workers {
    /// Threads that make points; 0 for one per core.
    pub threads: usize,
}
