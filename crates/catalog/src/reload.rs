//! Reading the folder again while the daemon serves.
//!
//! Good files are loaded, and each bad file is refused by itself, while the table that it held so far stays in use: a
//! folder that is half copied, or one damaged file in it, must not take down tables that work. A new [`Catalog`]
//! results, which replaces the old one in one step.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::Arc,
};

use schemars::JsonSchema;
use serde::Serialize;
use strew_config::Config;

use crate::{
    catalog::{Catalog, Preload, table_files},
    entry::Entry,
    error::CatalogError,
    key::{Key, Source},
    named::{Changes, Reread},
};

/// The changes since the folder was last read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Reload {
    /// The number of tables that are loaded now.
    pub tables: usize,
    /// Tables that were not there before, or not with this content.
    pub loaded: Vec<Serving>,
    /// Tables that answer as before, those among them whose files were refused.
    pub kept: Vec<Serving>,
    /// Tables that answer no more: their files are gone.
    pub removed: Vec<Serving>,
    /// Files that were not taken, and why.
    pub refused: Vec<Refusal>,
    /// The fields.
    pub fields: Changes,
    /// The lists of points that are left out.
    pub except: Changes,
    /// The worlds.
    pub worlds: Changes,
    /// The settings that changed in the files of the configuration, and take effect at the next start.
    pub at_next_start: Vec<String>,
}

type Kind = fn(&mut Reload) -> &mut Changes;

/// A table, as reported to the operator.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Serving {
    /// The noise profile.
    pub profile: String,
    /// The number α.
    pub alpha: String,
    /// The size of its map.
    pub map: String,
    /// The shares of its kinds, if it has some.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kinds: Option<String>,
    /// Its digest.
    pub digest: String,
    /// Where it comes from.
    pub source: String,
    /// The digest of the table in whose place it stands now.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub replaces: Option<String>,
}

/// A file that was not taken.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Refusal {
    /// The file, or the folder.
    pub source: String,
    /// Why.
    pub detail: String,
    /// The digest of the table from this file that serves on, if there is one.
    pub serving: Option<String>,
}

impl Serving {
    fn new(entry: &Entry, replaces: Option<&Entry>) -> Self {
        Self {
            profile: entry.key.profile.as_ref().into(),
            alpha: entry.key.alpha.to_string(),
            map: entry.key.size.to_string(),
            kinds: entry.key.mix.as_ref().map(|mix| mix.text()),
            digest: entry.digest.clone(),
            source: entry.source.to_string(),
            replaces: replaces.map(|other| other.digest.clone()),
        }
    }
}

impl Reload {
    /// Adds the changes of a kind of documents, and those that were not taken. Returns their new state.
    pub fn take<S>(&mut self, kind: Kind, (state, changes, refused): Reread<S>) -> S {
        *kind(self) = changes;
        let refusals = refused.into_iter().map(|(error, serving)| Refusal {
            detail: error.to_string(),
            source: error.source_name,
            serving,
        });
        self.refused.extend(refusals);
        state
    }

    /// Adds a file or a folder that was not taken.
    pub fn refuse_file(&mut self, source: Option<&Path>, detail: &impl std::fmt::Display) {
        self.refused.push(Refusal {
            source: source.map_or(String::new(), |source| source.display().to_string()),
            detail: detail.to_string(),
            serving: None,
        });
    }

    /// The digests of tables that are no longer loaded.
    pub fn gone(&self) -> impl Iterator<Item = &str> {
        let replaced = self.loaded.iter().filter_map(|new| new.replaces.as_deref());
        replaced.chain(self.removed.iter().map(|old| old.digest.as_str()))
    }
}

impl Catalog {
    /// The catalog after reading the fields and the lists of points again. What came of it is added to `reload`.
    pub fn reload_names(self, names: &Config, reload: &mut Reload) -> Self {
        let fields = reload.take(|all| &mut all.fields, self.fields.reload(&names.fields));
        let lists = reload.take(|all| &mut all.except, self.except.reload(&names.except));
        self.with_fields(fields).with_except(lists)
    }

    /// The catalog after reading the folder of tables again, and the changes.
    pub fn reload_tables(&self, folder: Option<&Path>) -> (Self, Reload) {
        let mut reload = Reload::default();
        let files = folder.map_or(Ok(vec![]), table_files);
        let mut after = self.clone();
        match files {
            Ok(files) => {
                after.entries.clone_from(&self.built_in);
                after.entries.extend(self.read(files, &mut reload.refused));
            }
            Err(error) => reload.refuse_file(folder, &error),
        }
        for (key, new) in &after.entries {
            match self.entries.get(key) {
                Some(old) if old.digest == new.digest => {
                    reload.kept.push(Serving::new(new, None));
                }
                old => reload.loaded.push(Serving::new(new, old.map(|old| &**old))),
            }
        }
        let gone = |(key, _): &(&Key, &Arc<Entry>)| !after.entries.contains_key(*key);
        let removed = self.entries.iter().filter(gone);
        reload.removed = removed.map(|(_, old)| Serving::new(old, None)).collect();
        reload.tables = after.tables().len();
        (after, reload)
    }

    /// Reads files. Of two for one key that one is taken which has served so far, else the first.
    fn read(
        &self,
        mut files: Vec<PathBuf>,
        refused: &mut Vec<Refusal>,
    ) -> BTreeMap<Key, Arc<Entry>> {
        let served: BTreeMap<&Path, &Arc<Entry>> = self
            .entries
            .values()
            .filter_map(|entry| match &entry.source {
                Source::File(path) => Some((path.as_path(), entry)),
                Source::Embedded(_) | Source::Memory(_) | Source::Pattern => None,
            })
            .collect();
        files.sort_by_key(|file| !served.contains_key(file.as_path()));
        let mut preload = Preload(self.preload_bytes);
        let mut taken: BTreeMap<Key, Arc<Entry>> = BTreeMap::new();
        let mut bad: Vec<(PathBuf, CatalogError)> = vec![];
        for file in files {
            match preload.read(file.clone()) {
                Ok(entry) => match taken.get(&entry.key) {
                    Some(first) => {
                        let twice = CatalogError::Twice {
                            key: entry.key.clone(),
                            first: first.source.clone(),
                            second: entry.source.clone(),
                        };
                        bad.push((file, twice));
                    }
                    None => {
                        // An unchanged table keeps its entry, so that it is not held twice.
                        let old = served.get(file.as_path()).map(|old| Arc::clone(old));
                        let same = old.filter(|old| old.digest == entry.digest);
                        let entry = same.unwrap_or_else(|| Arc::new(entry));
                        taken.insert(entry.key.clone(), entry);
                    }
                },
                Err(error) => bad.push((file, error)),
            }
        }
        for (file, error) in bad {
            let old = served.get(file.as_path());
            let serves_on = old.filter(|old| !taken.contains_key(&old.key)).copied();
            refused.push(Refusal {
                source: file.display().to_string(),
                detail: error.to_string(),
                serving: serves_on.map(|old| old.digest.clone()),
            });
            if let Some(old) = serves_on {
                taken.insert(old.key.clone(), old.clone());
            }
        }
        taken
    }
}
