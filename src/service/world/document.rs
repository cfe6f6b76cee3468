//! Worlds as documents, with what is known of them.

use std::{collections::BTreeMap, sync::Arc};

use crate::service::named::{self, Source};

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
    /// The names of its layers.
    pub layers: Vec<String>,
    /// The BLAKE3 digest of all that its points depend on, in hexadecimal: the document, its tables, fields and
    /// lists.
    pub digest: String,
}

/// The world that a query names.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// Its name.
    pub name: String,
    /// Its digest.
    pub digest: String,
    /// Whether the query names this digest, and nothing beside it that a server could change.
    pub is_pinned: bool,
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
