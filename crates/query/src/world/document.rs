//! Worlds as documents, with their checked drafts and digests.

use std::{ops::Deref, sync::Arc};

use strew_catalog::named::{Loaded, Names, Source};

use crate::{draft::Draft, set::Set};

#[derive(Clone, Debug, Default)]
pub struct Worlds {
    pub(super) entries: Names<World>,
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

impl Deref for Worlds {
    type Target = Names<World>;

    fn deref(&self) -> &Self::Target {
        &self.entries
    }
}

impl Loaded for World {
    const KIND: &'static str = "world";

    fn digest(&self) -> String {
        self.digest.clone()
    }
}
