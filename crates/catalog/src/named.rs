//! Documents that queries name, from the configuration and from folders: fields, worlds and lists of points.

use std::{
    collections::BTreeMap,
    fmt, fs, io,
    path::{Path, PathBuf},
    sync::Arc,
};

use schemars::JsonSchema;
use serde::Serialize;
use strew_config::{
    bounded_file,
    name::{ALLOWED, is_name},
};

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    Embedded,
    /// The configuration: the section, and the name in it.
    Config(&'static str, String),
    File(PathBuf),
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Embedded => f.write_str("built in"),
            Self::Config(section, name) => write!(f, "[{section}.{name}] of the configuration"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

/// A document that was not taken, and the digest of the one that stays in its place.
pub type Refused = (NamedError, Option<String>);

/// A state after reading all documents again, the changes, and the refused documents.
pub type Reread<S> = (S, Changes, Vec<Refused>);

/// The state of documents that are read at the start, where none may be refused.
pub fn all_of<S>((state, _, refused): Reread<S>) -> Result<S, NamedError> {
    match refused.into_iter().next() {
        Some((error, _)) => Err(error),
        None => Ok(state),
    }
}

/// A document that is loaded.
pub trait Loaded: Clone {
    /// Its noun, such as field, in lists of names.
    const KIND: &'static str;

    /// All that it means, in hexadecimal.
    fn digest(&self) -> String;
}

/// The documents of a kind that are loaded, by name.
#[derive(Clone, Debug)]
pub struct Names<T>(pub BTreeMap<String, Arc<T>>);

impl<T> Default for Names<T> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<T: Loaded> Names<T> {
    pub fn get(&self, name: &str) -> Option<&Arc<T>> {
        self.0.get(name)
    }

    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Arc<T>> {
        self.0.values()
    }

    /// The names, for faults: not all of a long list.
    pub fn names(&self) -> String {
        const SHOWN: usize = 16;
        let (kind, more) = (T::KIND, self.0.len().saturating_sub(SHOWN));
        let names: Vec<&str> = self.0.keys().take(SHOWN).map(String::as_str).collect();
        match (names.as_slice(), more) {
            ([], _) => format!("nothing: no {kind} is loaded"),
            (names, 0) => names.join(", "),
            (names, more) => {
                let names = names.join(", ");
                format!("{names}, and {more} more (see the list of {kind}s)")
            }
        }
    }

    pub(super) fn digest(&self, name: &str) -> Option<String> {
        self.0.get(name).map(|document| document.digest())
    }

    pub fn changes_to(&self, after: &Self) -> Changes {
        let mut changes = Changes::default();
        for (name, new) in &after.0 {
            let list = match self.digest(name) == Some(new.digest()) {
                true => &mut changes.kept,
                false => &mut changes.loaded,
            };
            list.push(name.clone());
        }
        let gone = self.0.keys().filter(|name| !after.0.contains_key(*name));
        changes.removed = gone.cloned().collect();
        changes
    }

    /// Reads all documents again, each by itself. A refused document leaves its earlier version in place; if the folder
    /// cannot be listed, all stay.
    pub fn read(
        &self,
        places: &Places<'_>,
        check: impl Fn(&Found, &str) -> Result<T, String>,
    ) -> (Self, Vec<Refused>) {
        let all = match places.each(check) {
            Ok(all) => all,
            Err(error) => return (self.clone(), vec![(error, None)]),
        };
        let (mut after, mut refused) = (Self::default(), vec![]);
        for (found, checked) in all {
            match checked {
                Ok(new) => drop(after.0.insert(found.name, Arc::new(new))),
                Err(error) => {
                    refused.push((error, self.digest(&found.name)));
                    if let Some(old) = self.get(&found.name) {
                        after.0.entry(found.name).or_insert_with(|| old.clone());
                    }
                }
            }
        }
        (after, refused)
    }
}

/// The changes since documents of a kind were last read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "ReloadedNames")]
pub struct Changes {
    /// Names that were not there before, or not with this content.
    pub loaded: Vec<String>,
    /// Names of what is as before.
    pub kept: Vec<String>,
    /// Names of what is gone.
    pub removed: Vec<String>,
}

impl Changes {
    /// Whether anything is other than before.
    pub const fn is_any(&self) -> bool {
        !self.loaded.is_empty() || !self.removed.is_empty()
    }
}

/// Why a document cannot be loaded.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{source_name}: {detail}")]
pub struct NamedError {
    pub source_name: String,
    pub detail: String,
}

pub type Checked<T> = (Found, Result<T, NamedError>);

/// A document that is found, and not checked yet.
#[derive(Clone, Debug)]
pub struct Found {
    pub name: String,
    pub source: Source,
    /// Its text: JSON, or lines; or why it cannot be read.
    pub(super) text: Result<String, String>,
}

#[derive(Clone, Copy, Debug)]
pub struct Places<'a> {
    pub section: &'static str,
    pub named: &'a BTreeMap<String, toml::Table>,
    /// The folder, if there is one.
    pub folder: Option<&'a Path>,
    pub endings: &'static [&'static str],
    /// The endings of files that are rasters, unless a document has the same name: then it says how to read them.
    pub rasters: &'static [&'static str],
    /// The most bytes of a file.
    pub most_bytes: u64,
}

impl Places<'_> {
    /// The documents, those of the configuration first.
    fn found(&self) -> Result<Vec<Found>, NamedError> {
        let section = |(name, table): (&String, &toml::Table)| Found {
            name: name.clone(),
            source: Source::Config(self.section, name.clone()),
            text: serde_json::to_string(table).map_err(|error| error.to_string()),
        };
        let mut all: Vec<Found> = self.named.iter().map(section).collect();
        if let Some(folder) = self.folder {
            let listed = files_of(folder).map_err(|error| NamedError {
                source_name: format!("folder {}", folder.display()),
                detail: error.to_string(),
            })?;
            let of = |endings: &'static [&str]| {
                let is_of = move |path: &&PathBuf| has_ending(path, endings);
                listed.iter().filter(is_of)
            };
            let is_named = |raster: &&PathBuf| {
                of(self.endings).all(|document| document.file_stem() != raster.file_stem())
            };
            let files = of(self.endings).chain(of(self.rasters).filter(is_named));
            all.extend(files.map(|path| Found::of_file(path, self.rasters, self.most_bytes)));
        }
        Ok(all)
    }

    /// Checks every document by itself. Of two of a name the first counts.
    pub fn each<T>(
        &self,
        check: impl Fn(&Found, &str) -> Result<T, String>,
    ) -> Result<Vec<Checked<T>>, NamedError> {
        let mut all: Vec<Checked<T>> = vec![];
        for found in self.found()? {
            let first = all.iter().find(|(first, _)| first.name == found.name);
            let checked = match (first, &found.text) {
                (Some((first, _)), _) => Err(format!(
                    "{} has the name `{}`, too: keep one",
                    first.source, found.name
                )),
                _ if !is_name(&found.name) => {
                    Err(format!("`{}` is no name; allowed: {ALLOWED}", found.name))
                }
                (None, Ok(text)) => check(&found, text),
                (None, Err(detail)) => Err(detail.clone()),
            };
            let checked = checked.map_err(|detail| found.error(detail));
            all.push((found, checked));
        }
        Ok(all)
    }
}

/// All files of a folder, in the order of their names.
pub(super) fn files_of(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let paths = fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
    let mut paths = paths.collect::<io::Result<Vec<_>>>()?;
    paths.sort();
    Ok(paths)
}

/// TOML as JSON.
pub(super) fn json_of(text: &str) -> Result<String, String> {
    let table = text
        .parse::<toml::Table>()
        .map_err(|error| error.to_string())?;
    serde_json::to_string(&table).map_err(|error| error.to_string())
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| endings.contains(&ending))
}

impl Found {
    /// A file: its text, of TOML as JSON, of a raster the field of its pixels.
    pub(super) fn of_file(path: &Path, rasters: &[&str], most: u64) -> Self {
        let part = |part: Option<&std::ffi::OsStr>| {
            part.unwrap_or_default().to_string_lossy().into_owned()
        };
        let read = || bounded_file::read_text(path, most).map_err(|error| error.to_string());
        Self {
            name: part(path.file_stem()),
            source: Source::File(path.into()),
            text: if has_ending(path, rasters) {
                let file = part(path.file_name());
                Ok(serde_json::json!({ "raster": { "file": file } }).to_string())
            } else if has_ending(path, &["toml"]) {
                read().and_then(|text| json_of(&text))
            } else {
                read()
            },
        }
    }

    pub(super) fn error(&self, detail: impl Into<String>) -> NamedError {
        NamedError {
            source_name: self.source.to_string(),
            detail: detail.into(),
        }
    }
}
