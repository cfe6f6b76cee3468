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
pub type Refused<E> = (E, Option<String>);

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
    /// The changes from one state to another; `digest` identifies a document.
    pub fn between<T>(
        before: &BTreeMap<String, Arc<T>>,
        after: &BTreeMap<String, Arc<T>>,
        digest: impl Fn(&T) -> String,
    ) -> Self {
        let mut changes = Self::default();
        for (name, new) in after {
            let is_same = (before.get(name)).is_some_and(|old| digest(old) == digest(new));
            let list = match is_same {
                true => &mut changes.kept,
                false => &mut changes.loaded,
            };
            list.push(name.clone());
        }
        let gone = before.keys().filter(|name| !after.contains_key(*name));
        changes.removed = gone.cloned().collect();
        changes
    }

    /// Whether anything is other than before.
    pub const fn is_any(&self) -> bool {
        !self.loaded.is_empty() || !self.removed.is_empty()
    }
}

/// Names for faults, shortened if there are many. `what` is their kind.
pub fn listed<'a>(what: &str, names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 16;
    let more = names.len().saturating_sub(SHOWN);
    let names: Vec<&str> = names.take(SHOWN).collect();
    match (names.as_slice(), more) {
        ([], _) => format!("nothing: no {what} is loaded"),
        (names, 0) => names.join(", "),
        (names, more) => format!(
            "{}, and {more} more (see the list of {what}s)",
            names.join(", ")
        ),
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
    text: Result<String, String>,
}

#[derive(Clone, Copy, Debug)]
pub struct Places<'a> {
    pub section: &'static str,
    pub named: &'a BTreeMap<String, toml::Table>,
    /// The folder, if there is one.
    pub folder: Option<&'a Path>,
    pub endings: &'static [&'static str],
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
            let files = files_with(folder, self.endings).map_err(|detail| NamedError {
                source_name: format!("folder {}", folder.display()),
                detail,
            })?;
            all.extend(files.into_iter().map(|path| Found {
                name: (path.file_stem().unwrap_or_default().to_string_lossy()).into_owned(),
                text: read(&path, self.most_bytes),
                source: Source::File(path),
            }));
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
            let checked = checked.map_err(|detail| NamedError {
                source_name: found.source.to_string(),
                detail,
            });
            all.push((found, checked));
        }
        Ok(all)
    }

    /// Checks every document by itself. A refused document leaves its earlier version in place.
    pub fn over<T>(
        &self,
        before: &BTreeMap<String, Arc<T>>,
        digest: impl Fn(&T) -> String,
        check: impl Fn(&Found, &str) -> Result<T, String>,
    ) -> Result<Over<T>, NamedError> {
        let (mut after, mut refused) = (BTreeMap::new(), vec![]);
        for (found, checked) in self.each(check)? {
            match checked {
                Ok(new) => drop(after.insert(found.name, Arc::new(new))),
                Err(error) => {
                    let old = before.get(&found.name);
                    refused.push((error, old.map(|old| digest(old))));
                    if let Some(old) = old {
                        after.entry(found.name).or_insert_with(|| Arc::clone(old));
                    }
                }
            }
        }
        Ok((after, refused))
    }
}

pub type Over<T> = (BTreeMap<String, Arc<T>>, Vec<Refused<NamedError>>);

/// The files of a folder with one of some endings, in the order of their names.
fn files_with(folder: &Path, endings: &[&str]) -> Result<Vec<PathBuf>, String> {
    let listed = || -> io::Result<Vec<PathBuf>> {
        fs::read_dir(folder)?
            .map(|entry| Ok(entry?.path()))
            .collect()
    };
    let mut paths = listed().map_err(|error| error.to_string())?;
    paths.retain(|path| {
        let ending = path.extension().and_then(|ending| ending.to_str());
        ending.is_some_and(|ending| endings.contains(&ending))
    });
    paths.sort();
    Ok(paths)
}

/// The text of a file; of TOML as JSON.
fn read(path: &Path, most: u64) -> Result<String, String> {
    let text = bounded_file::read_text(path, most).map_err(|error| error.to_string())?;
    if path.extension().is_none_or(|ending| ending != "toml") {
        return Ok(text);
    }
    let table: toml::Table = text
        .parse()
        .map_err(|error: toml::de::Error| error.to_string())?;
    serde_json::to_string(&table).map_err(|error| error.to_string())
}
