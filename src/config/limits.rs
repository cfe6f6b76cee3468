//! Settings of work: tables, fields, limits of queries and of memory, threads.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

/// The most that a query may request, and that answers may hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
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

/// Which fields to load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fields {
    /// Whether the built-in one is loaded.
    pub embedded: bool,
    /// A folder with documents and rasters; empty for none.
    pub folder: PathBuf,
    /// The most memory that the pixels of all fields may take, in bytes.
    pub max_bytes: usize,
    /// The most memory that fields may take which clients send to name them later, in bytes; 0 for none.
    pub max_sent_bytes: usize,
    /// Fields by name, as documents.
    #[serde(flatten)]
    pub named: BTreeMap<String, toml::Table>,
}

impl Fields {
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
    /// The time between two checks of the files, in seconds; 0 for never.
    pub watch_seconds: f64,
}

/// Who makes points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Workers {
    /// Threads that make points; 0 for one per core.
    pub threads: usize,
}
