//! Worlds as documents, with their checked drafts and digests.

use std::{collections::BTreeMap, sync::Arc};

use strew_catalog::named::{self, Source};

use crate::{draft::Draft, set::Set};

#[derive(Clone, Debug, Default)]
pub struct Worlds {
    pub(super) entries: BTreeMap<String, Arc<World>>,
    pub(super) most_vertices: usize,
}

#[derive(Clone, Debug)]
pub struct World {
    pub name: String,
    pub source: Source,
    pub json: Arc<str>,
    pub draft: Draft,
    /// Its layers, checked against the tables and fields that are loaded; `None` if it has none or does not fit these.
    pub(crate) sets: Option<Arc<[Set]>>,
    pub layers: Vec<String>,
    /// The BLAKE3 digest of all that its points depend on, in hexadecimal: the document, its tables, fields and
    /// lists.
    pub digest: String,
}

impl Worlds {
    pub fn get(&self, name: &str) -> Option<&Arc<World>> {
        self.entries.get(name)
    }

    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Arc<World>> {
        self.entries.values()
    }

    pub fn names(&self) -> String {
        named::listed("world", self.entries.keys().map(String::as_str))
    }
}
