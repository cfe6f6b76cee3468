//! Worlds as documents, with their checked drafts and digests.

use std::{collections::BTreeMap, sync::Arc};

use strew_catalog::named::{self, Source};

use crate::{draft::Draft, set::Set};

/// The worlds that are loaded, by name.
#[derive(Clone, Debug, Default)]
pub struct Worlds {
    pub(super) entries: BTreeMap<String, Arc<World>>,
    /// The most vertices of the polygons of one.
    pub(super) most_vertices: usize,
}

/// A world.
#[derive(Clone, Debug)]
pub struct World {
    /// Its name.
    pub name: String,
    /// Where it comes from.
    pub source: Source,
    /// The members of a query, as JSON.
    pub json: Arc<str>,
    /// The members, read and checked.
    pub draft: Draft,
    /// Its layers, checked against the tables and fields that are loaded; `None` if it has none or does not fit these.
    pub(crate) sets: Option<Arc<[Set]>>,
    /// The names of its layers.
    pub layers: Vec<String>,
    /// The BLAKE3 digest of all that its points depend on, in hexadecimal: the document, its tables, fields and
    /// lists.
    pub digest: String,
}

impl Worlds {
    /// The world of a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Arc<World>> {
        self.entries.get(name)
    }

    /// All worlds, by name.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Arc<World>> {
        self.entries.values()
    }

    /// The names, for faults.
    #[must_use]
    pub fn names(&self) -> String {
        named::listed("world", self.entries.keys().map(String::as_str))
    }
}
