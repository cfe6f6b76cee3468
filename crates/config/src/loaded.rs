//! Settings of the data to load: tables, fields, worlds, lists of points.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tables {
    pub embedded: bool,
    pub folder: PathBuf,
    pub preload_bytes: u64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fields {
    pub embedded: bool,
    pub folder: PathBuf,
    pub max_bytes: usize,
    pub max_sent_bytes: usize,
    #[serde(flatten)]
    pub named: BTreeMap<String, toml::Table>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Worlds {
    pub folder: PathBuf,
    #[serde(flatten)]
    pub named: BTreeMap<String, toml::Table>,
}

/// The settings of lists of points to load, which queries leave out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Except {
    pub folder: PathBuf,
    pub max_ids: usize,
    pub max_sent_bytes: usize,
    #[serde(flatten)]
    pub named: BTreeMap<String, toml::Table>,
}

/// A file or folder, unless it is empty.
pub(super) fn some(path: &Path) -> Option<&Path> {
    Some(path).filter(|path| !path.as_os_str().is_empty())
}

macro_rules! folders {
    ($($Section:ident)+) => {
        $(impl $Section {
            pub fn folder(&self) -> Option<&Path> {
                some(&self.folder)
            }
        })+
    };
}

folders!(Tables Fields Worlds Except);
