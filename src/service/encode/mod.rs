//! Encoders: a planned query as bytes, block by block, when they are asked for.
//!
//! An [`Answer`] is a plain iterator that owns all it needs and can move between threads. It makes
//! the whole document: what comes before the points, the points, and the summary after them.

mod buffer;
mod csv;
mod json;
mod ndjson;
mod packed;
mod text;

use bytes::Bytes;
use serde::Serialize;
use strew_core::{ALGORITHM_VERSION, sample};

use super::{Entry, Planned, query::Resolved};
use text::TextBlocks;

pub use buffer::Pool;
pub use packed::{Packed, Scalars};
pub use text::{id_text, write_id, write_number};

/// The formats of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// One JSON document.
    Json,
    /// One JSON document a line.
    Ndjson,
    /// Comma-separated values.
    Csv,
    /// Interleaved little-endian `f32` pairs, relative to the box's lower corner.
    F32,
    /// Interleaved little-endian `f64` pairs.
    F64,
}

impl Encoding {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::Json, Self::Ndjson, Self::Csv, Self::F32, Self::F64];

    /// The name in queries.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Ndjson => "ndjson",
            Self::Csv => "csv",
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// The format of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|encoding| encoding.name() == name)
    }

    /// The content type, when the format is asked for by name.
    #[must_use]
    pub const fn content_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Ndjson => "application/x-ndjson",
            Self::Csv => "text/csv; charset=utf-8; header=present",
            Self::F32 | Self::F64 => "application/octet-stream",
        }
    }

    /// The bytes of a point, where all have the same.
    #[must_use]
    pub const fn point_bytes(self) -> Option<u64> {
        match self {
            Self::F32 => Some(8),
            Self::F64 => Some(16),
            Self::Json | Self::Ndjson | Self::Csv => None,
        }
    }
}

/// A planned query on its way out: the blocks of its answer in one format.
#[derive(Debug)]
pub struct Answer {
    blocks: AnyBlocks,
}

#[derive(Debug)]
enum AnyBlocks {
    Json(TextBlocks<json::Json>),
    Ndjson(TextBlocks<ndjson::Ndjson>),
    Csv(TextBlocks<csv::Csv>),
    F32(Packed<sample::F32>),
    F64(Packed<sample::F64>),
}

impl Answer {
    /// The answer to a planned query, in blocks of about `block_bytes`.
    #[must_use]
    pub fn new(planned: &Planned, encoding: Encoding, block_bytes: usize) -> Self {
        let head = Head::new(planned, encoding);
        let plan = &planned.plan;
        let blocks = match encoding {
            Encoding::Json => {
                AnyBlocks::Json(TextBlocks::new(plan, json::Json::new(head), block_bytes))
            }
            Encoding::Ndjson => {
                let lines = ndjson::Ndjson::new(head);
                AnyBlocks::Ndjson(TextBlocks::new(plan, lines, block_bytes))
            }
            Encoding::Csv => AnyBlocks::Csv(TextBlocks::new(plan, csv::Csv, block_bytes)),
            Encoding::F32 => AnyBlocks::F32(Packed::new(plan, block_bytes)),
            Encoding::F64 => AnyBlocks::F64(Packed::new(plan, block_bytes)),
        };
        Self { blocks }
    }

    /// The exact size of a planned answer, where it is known before.
    #[must_use]
    pub fn size(planned: &Planned, encoding: Encoding) -> Option<u64> {
        let points = u64::try_from(planned.count()).ok()?;
        encoding.point_bytes()?.checked_mul(points)
    }

    /// How many points have been encoded so far.
    #[must_use]
    pub const fn points(&self) -> u64 {
        match &self.blocks {
            AnyBlocks::Json(blocks) => blocks.points(),
            AnyBlocks::Ndjson(blocks) => blocks.points(),
            AnyBlocks::Csv(blocks) => blocks.points(),
            AnyBlocks::F32(blocks) => blocks.points(),
            AnyBlocks::F64(blocks) => blocks.points(),
        }
    }
}

impl Iterator for Answer {
    type Item = Bytes;

    fn next(&mut self) -> Option<Bytes> {
        match &mut self.blocks {
            AnyBlocks::Json(blocks) => blocks.next(),
            AnyBlocks::Ndjson(blocks) => blocks.next(),
            AnyBlocks::Csv(blocks) => blocks.next(),
            AnyBlocks::F32(blocks) => blocks.next(),
            AnyBlocks::F64(blocks) => blocks.next(),
        }
    }
}

/// What an answer says about itself: the query as understood, and the table.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Head {
    pub(super) query: QueryEcho,
    pub(super) table: TableEcho,
    pub(super) count: u128,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct QueryEcho {
    #[serde(flatten)]
    resolved: Resolved,
    format: &'static str,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct TableEcho {
    profile: String,
    alpha: String,
    radius: u32,
    digest: String,
    algorithm: u32,
}

impl Head {
    fn new(planned: &Planned, encoding: Encoding) -> Self {
        let Entry {
            key,
            radius,
            digest,
            ..
        } = &*planned.entry;
        Self {
            query: QueryEcho {
                resolved: planned.query.resolved(),
                format: encoding.name(),
            },
            table: TableEcho {
                profile: key.profile.as_ref().into(),
                alpha: key.alpha.to_string(),
                radius: *radius,
                digest: digest.clone(),
                algorithm: ALGORITHM_VERSION,
            },
            count: planned.count(),
        }
    }
}
