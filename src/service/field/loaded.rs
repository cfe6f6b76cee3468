//! The fields that queries may name: those of the configuration and those of a folder.
//!
//! In the folder, a `.json` or `.toml` file is a document, and a raster (`.png`, `.tif`, `.tiff`, `.npy`)
//! is a field of its pixels, unless a document has the same name: then it says how to read the raster. Every
//! field is read and checked once, at the start or when the folder is read again; one whose files are
//! unchanged is kept as it is.

use std::{collections::BTreeMap, path::Path, sync::Arc};

use schemars::JsonSchema;
use serde::Serialize;

use super::{
    Document,
    files::{self, Stamp},
    named::{FieldError, NamedField, Source},
    read,
    unbuilt::{Unbuilt, listed, names},
};
use crate::config::Fields as Settings;

/// The field that is built into the program: its name and its document.
const EMBEDDED: (&str, &str) = ("forest", include_str!("../../../config/fields/forest.toml"));

/// The fields that are loaded, by name.
#[derive(Clone, Debug, Default)]
pub struct Fields {
    entries: BTreeMap<String, Arc<NamedField>>,
}

/// What reading the fields again changed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "ReloadedFields")]
pub struct FieldReload {
    /// Names of fields that were not there before, or not with this content.
    pub loaded: Vec<String>,
    /// Names of fields that answer as before.
    pub kept: Vec<String>,
    /// Names of fields that are gone.
    pub removed: Vec<String>,
}

impl Fields {
    /// Loads the fields that the settings name.
    ///
    /// # Errors
    /// The first that is not valid.
    pub fn load(settings: &Settings) -> Result<Self, FieldError> {
        let (fields, refused) = Self::default().read(settings);
        match refused.into_iter().next() {
            Some((error, _)) => Err(error),
            None => Ok(fields),
        }
    }

    /// The fields after reading everything again, what changed, and what was refused, with the digest of the
    /// field that stays in its place.
    #[must_use]
    pub fn reload(
        &self,
        settings: &Settings,
    ) -> (Self, FieldReload, Vec<(FieldError, Option<String>)>) {
        let (after, refused) = self.read(settings);
        let mut changes = FieldReload::default();
        for (name, new) in &after.entries {
            let old = self.entries.get(name);
            let is_same = old.is_some_and(|old| old.spec.digest() == new.spec.digest());
            let list = if is_same {
                &mut changes.kept
            } else {
                &mut changes.loaded
            };
            list.push(name.clone());
        }
        let gone = self.entries.keys();
        let gone = gone.filter(|name| !after.entries.contains_key(*name));
        changes.removed = gone.cloned().collect();
        (after, changes, refused)
    }

    /// The field of a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Arc<NamedField>> {
        self.entries.get(name)
    }

    /// All fields, by name.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Arc<NamedField>> {
        self.entries.values()
    }

    /// Adds a field, in the place of one of the same name.
    pub fn insert(&mut self, field: NamedField) {
        self.entries.insert(field.name.clone(), Arc::new(field));
    }

    /// The names, for faults: not all of a long list.
    #[must_use]
    pub fn names(&self) -> String {
        listed(&self.entries)
    }

    /// Reads everything; what is refused keeps the field that it was before.
    fn read(&self, settings: &Settings) -> (Self, Vec<(FieldError, Option<String>)>) {
        let mut refused = vec![];
        let mut open: Vec<Unbuilt> = vec![];
        let base = settings.folder().unwrap_or(Path::new("."));
        let mut after = Self::default();
        if settings.embedded {
            after.insert_embedded();
        }
        for (name, table) in &settings.named {
            let source = Source::Config(name.clone());
            let document = read::read_toml(&format!("fields.{name}"), table);
            let document = document.map_err(|faults| super::listed(&faults));
            open.push(Unbuilt::new(name.clone(), source, document, Path::new(".")));
        }
        if let Some(folder) = settings.folder() {
            match files::of_folder(folder) {
                Ok(paths) => {
                    open.extend(paths.into_iter().map(|path| Unbuilt::of_file(path, base)))
                }
                Err(detail) => {
                    let source_name = format!("folder {}", folder.display());
                    refused.push((
                        FieldError {
                            source_name,
                            detail,
                        },
                        None,
                    ));
                    // All of the folder stays.
                    return (self.clone(), refused);
                }
            }
        }
        let mut seen: BTreeMap<String, String> = BTreeMap::new();
        open.retain(|field| match seen.get(&field.name) {
            Some(first) => {
                let detail = format!("{first} has the name `{}`, too: keep one", field.name);
                refused.push((field.error(detail), self.digest(&field.name)));
                false
            }
            None => {
                seen.insert(field.name.clone(), field.source.to_string());
                true
            }
        });
        let mut room = settings.max_bytes;
        // Documents may name other fields, in any order: those that do not yet are built first.
        loop {
            let before = open.len();
            open = open
                .into_iter()
                .filter_map(|field| self.settle(field, &mut after, &mut room, &mut refused, false))
                .collect();
            if open.len() == before {
                break;
            }
        }
        for field in open {
            let _ = self.settle(field, &mut after, &mut room, &mut refused, true);
        }
        (after, refused)
    }

    /// Adds the built-in field. A test builds it.
    fn insert_embedded(&mut self) {
        let (name, text) = EMBEDDED;
        let table = text.parse::<toml::Table>().ok();
        let document = table.and_then(|table| read::read_toml("field", &table).ok());
        let document = document.ok_or_else(|| "the built-in field does not read".into());
        let field = Unbuilt::new(name.into(), Source::Embedded, document, Path::new(""));
        if let Ok(field) = field.build(&self.entries, 0, Stamp::default()) {
            self.insert(field);
        }
    }

    fn digest(&self, name: &str) -> Option<String> {
        self.entries.get(name).map(|field| field.digest())
    }

    /// Builds a field, keeps it, or refuses it; `None` if it is done. A field that names others that are not
    /// there yet waits, unless it is the last chance.
    fn settle(
        &self,
        field: Unbuilt,
        after: &mut Self,
        room: &mut usize,
        refused: &mut Vec<(FieldError, Option<String>)>,
        is_last: bool,
    ) -> Option<Unbuilt> {
        let waits = match &field.document {
            Ok(document) => !is_last && names(document).any(|name| after.get(name).is_none()),
            Err(_) => false,
        };
        if waits {
            return Some(field);
        }
        let old = self.entries.get(&field.name);
        let stamp = field.stamp();
        let unchanged = old.filter(|old| {
            let is_alone = names(&old.document).next().is_none();
            is_alone && old.source == field.source && old.stamp == stamp
        });
        let built = match unchanged {
            Some(old) if field.document.as_ref() == Ok(&old.document) => Ok(Arc::clone(old)),
            _ => field.build(&after.entries, *room, stamp).map(Arc::new),
        };
        match built {
            Ok(built) => {
                *room = room.saturating_sub(built.bytes);
                after.entries.insert(built.name.clone(), built);
            }
            Err(detail) => {
                refused.push((field.error(detail), old.map(|old| old.digest())));
                if let Some(old) = old {
                    after.entries.insert(old.name.clone(), Arc::clone(old));
                }
            }
        }
        None
    }
}

/// The field of a file that a command names: a document or a raster. A document may name others in its folder.
///
/// # Errors
/// What is wrong with it.
pub fn from_file(path: &Path, fields: &Fields) -> Result<NamedField, FieldError> {
    let base = path.parent().unwrap_or(Path::new(""));
    let mut field = Unbuilt::of_file(path.into(), base);
    if field.name.is_empty() {
        field.name = "field".into();
    }
    let is_known = |name: &str| fields.get(name).is_some();
    let has_others = (field.document.as_ref()).is_ok_and(|document| !names(document).all(is_known));
    let mut all = fields.clone();
    if has_others {
        let (beside, _) = Fields::default().read(&Settings {
            embedded: false,
            folder: match base.as_os_str().is_empty() {
                true => Path::new(".").into(),
                false => base.into(),
            },
            max_bytes: usize::MAX,
            max_sent_bytes: 0,
            named: BTreeMap::new(),
        });
        for (name, other) in beside.entries {
            all.entries.entry(name).or_insert(other);
        }
    }
    let built = field.build(&all.entries, usize::MAX, Stamp::default());
    built.map_err(|detail| field.error(detail))
}

/// The field of a document that a command makes.
///
/// # Errors
/// What is wrong with it.
pub fn from_document(
    name: &str,
    document: Document,
    fields: &Fields,
) -> Result<NamedField, FieldError> {
    let source = Source::Config(name.into());
    let field = Unbuilt::new(name.into(), source, Ok(document), Path::new(""));
    let built = field.build(&fields.entries, usize::MAX, Stamp::default());
    built.map_err(|detail| field.error(detail))
}

#[cfg(test)]
mod tests;
