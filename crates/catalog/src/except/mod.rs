//! Points that were taken away: lists of ids that answers leave out.
//!
//! A query names ids, and lists of the configuration, of a folder or of a client. A point that was taken away keeps its
//! place: other layers still keep clear of it, and the attributes and ids of others stay. So nothing appears where a
//! tree was felled. [`Except`] has the points that one set lacks; planning cuts a hole of one coordinate for each of
//! its points that lie in the region, and counts, cursors and parts follow from the area that is left.

mod holes;
mod list;

use std::sync::Arc;

use strew_core::{PointId, PointSet};
use strew_error::Fault;

pub use list::{Lists, NamedList, Section, split};

pub const MOST_GIVEN: usize = 10_000;
/// The most points that all sets of a query together leave out within its region.
pub const MOST_HOLES: usize = 10_000;

/// Sorted ids, each once, with their digest.
#[derive(Clone, Debug, PartialEq)]
pub struct Ids {
    sorted: Vec<PointId>,
    digest: String,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Except {
    /// The ids of the query, which must be points of the set, each with the name of its field.
    pub given: Vec<(String, PointId)>,
    pub names: Vec<String>,
    /// Whether the name of one may stand for another list later.
    pub may_change: bool,
    pub parts: Vec<Arc<Ids>>,
}

impl Ids {
    pub fn new(mut ids: Vec<PointId>) -> Self {
        ids.sort_unstable_by_key(|id| (id.x, id.y));
        ids.dedup();
        ids.shrink_to_fit();
        let mut hasher = blake3::Hasher::new();
        for id in &ids {
            hasher.update(&id.x.to_le_bytes());
            hasher.update(&id.y.to_le_bytes());
        }
        Self {
            digest: hasher.finalize().to_hex().to_string(),
            sorted: ids,
        }
    }

    pub const fn len(&self) -> usize {
        self.sorted.len()
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.sorted.is_empty()
    }

    /// The digest of all of them, in hexadecimal.
    pub fn digest(&self) -> &str {
        &self.digest
    }
}

impl Except {
    /// The digest of all ids, in hexadecimal.
    pub fn digest(&self) -> String {
        match self.parts.as_slice() {
            [only] => only.digest.clone(),
            parts => {
                let mut hasher = blake3::Hasher::new();
                for part in parts {
                    hasher.update(part.digest.as_bytes());
                }
                hasher.finalize().to_hex().to_string()
            }
        }
    }

    /// Refuses ids of the query that are no points of a set's table. Those that the set leaves out anyway, by its
    /// share or its field, are allowed.
    pub fn check(&self, layer: &str, points: &PointSet) -> Result<(), Fault> {
        let wrong = self
            .given
            .iter()
            .find(|(_, id)| points.block(*id).is_none());
        let Some((field, id)) = wrong else {
            return Ok(());
        };
        let detail = match layer {
            "" => "this set has no such point".to_owned(),
            layer => format!("the layer {layer} has no such point"),
        };
        Err(Fault::new(field, id, detail, "ids of points of this set"))
    }
}
