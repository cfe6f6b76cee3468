//! Settings of the data to load: tables, fields, worlds, lists of points.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use super::some;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tables {
    pub embedded: bool,
    /// A folder with more; empty for none.
    pub folder: PathBuf,
    /// The bytes of the folder's files that are read and held at the start. Bounds memory.
    pub preload_bytes: u64,
}

impl Tables {
    pub fn folder(&self) -> Option<&Path> {
        some(&self.folder)
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fields {
    pub embedded: bool,
    /// A folder with documents and rasters; empty for none.
    pub folder: PathBuf,
    /// The most memory that the pixels of all fields may take, in bytes.
    pub max_bytes: usize,
    /// The most memory that fields may take which clients send to name them later, in bytes; 0 for none.
    pub max_sent_bytes: usize,
    #[serde(flatten)]
    pub named: BTreeMap<String, toml::Table>,
}

impl Fields {
    pub fn folder(&self) -> Option<&Path> {
        some(&self.folder)
    }
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Worlds {
    /// A folder with documents; empty for none.
    pub folder: PathBuf,
    #[serde(flatten)]
    pub named: BTreeMap<String, toml::Table>,
}

impl Worlds {
    pub fn folder(&self) -> Option<&Path> {
        some(&self.folder)
    }
}

/// The settings of lists of points to load, which queries leave out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Except {
    /// A folder with lists; empty for none.
    pub folder: PathBuf,
    /// The most ids of one list. Bounds memory.
    pub max_ids: usize,
    /// The most memory that lists may take which clients send to name them later, in bytes; 0 for none.
    pub max_sent_bytes: usize,
    #[serde(flatten)]
    pub named: BTreeMap<String, toml::Table>,
}

impl Except {
    pub fn folder(&self) -> Option<&Path> {
        some(&self.folder)
    }
}
