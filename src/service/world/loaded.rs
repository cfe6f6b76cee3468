//! Loading worlds: from the configuration and from a folder, at the start and again.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{Catalog, Error, Source, World, Worlds};
use crate::{
    bounded_file,
    config::Worlds as Settings,
    service::{
        field::documents_of,
        named::{Changes, NAME, Refused, is_name},
    },
};

/// The longest document.
const DOCUMENT_BYTES: u64 = 4 << 20;

/// Why a world cannot be loaded.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{source_name}: {detail}")]
pub struct WorldError {
    /// The file, the folder or the section of the configuration.
    pub source_name: String,
    /// What is wrong.
    pub detail: String,
}

/// A world that is not checked yet: the document as JSON, or why it cannot be read.
struct Found {
    name: String,
    source: Source,
    json: Result<String, String>,
}

impl Worlds {
    /// Loads the worlds that the settings name, over the tables and fields that they are of.
    ///
    /// # Errors
    /// The first that is not valid.
    pub fn load(
        settings: &Settings,
        catalog: &Catalog,
        most_vertices: usize,
    ) -> Result<Self, WorldError> {
        let none = Self {
            most_vertices,
            ..Self::default()
        };
        let (worlds, refused) = none.read(settings, catalog);
        match refused.into_iter().next() {
            Some((error, _)) => Err(error),
            None => Ok(worlds),
        }
    }

    /// The worlds after reading everything again, what changed, and what was refused: the world of before stays
    /// in its place.
    #[must_use]
    pub fn reload(
        &self,
        settings: &Settings,
        catalog: &Catalog,
    ) -> (Self, Changes, Vec<Refused<WorldError>>) {
        let (after, refused) = self.read(settings, catalog);
        let changes = Changes::between(&self.entries, &after.entries, |world| world.digest.clone());
        (after, changes, refused)
    }

    /// Reads every world by itself.
    ///
    /// # Errors
    /// [`WorldError`] if the folder cannot be read.
    pub fn each(
        settings: &Settings,
        catalog: &Catalog,
        most_vertices: usize,
    ) -> Result<Vec<(String, Result<World, WorldError>)>, WorldError> {
        let mut all: Vec<(String, Result<World, WorldError>)> = vec![];
        for found in found(settings)? {
            let first = all.iter().find(|(name, _)| *name == found.name);
            let world = match first {
                Some((_, first)) => Err(found.twice(first.as_ref().map_or_else(
                    |error| error.source_name.clone(),
                    |world| world.source.to_string(),
                ))),
                None => found.check(catalog, most_vertices),
            };
            all.push((found.name, world));
        }
        Ok(all)
    }

    fn read(&self, settings: &Settings, catalog: &Catalog) -> (Self, Vec<Refused<WorldError>>) {
        let mut after = Self {
            entries: BTreeMap::new(),
            ..*self
        };
        let each = match Self::each(settings, catalog, self.most_vertices) {
            Ok(each) => each,
            // All of them stay.
            Err(error) => return (self.over(catalog), vec![(error, None)]),
        };
        let mut refused = vec![];
        for (name, world) in each {
            match world {
                Ok(world) => drop(after.entries.insert(name, Arc::new(world))),
                Err(error) => {
                    let old = self.get(&name);
                    refused.push((error, old.map(|old| old.digest.clone())));
                    if let Some(old) = old {
                        let slot = after.entries.entry(name);
                        slot.or_insert_with(|| Arc::clone(old));
                    }
                }
            }
        }
        (after, refused)
    }
}

/// The documents that the settings name, those of the configuration first.
fn found(settings: &Settings) -> Result<Vec<Found>, WorldError> {
    let section = |(name, value): (&String, &toml::Table)| Found {
        name: name.clone(),
        source: Source::Config("worlds", name.clone()),
        json: serde_json::to_string(value).map_err(|error| error.to_string()),
    };
    let mut all: Vec<Found> = settings.named.iter().map(section).collect();
    if let Some(folder) = settings.folder() {
        let files = documents_of(folder).map_err(|detail| WorldError {
            source_name: format!("folder {}", folder.display()),
            detail,
        })?;
        all.extend(files.into_iter().map(Found::of_file));
    }
    Ok(all)
}

impl Found {
    fn of_file(path: PathBuf) -> Self {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        Self {
            name: name.into_owned(),
            json: read(&path),
            source: Source::File(path),
        }
    }

    fn error(&self, detail: String) -> WorldError {
        WorldError {
            source_name: self.source.to_string(),
            detail,
        }
    }

    fn twice(&self, first: String) -> WorldError {
        self.error(format!(
            "{first} has the name `{}`, too: keep one",
            self.name
        ))
    }

    fn check(&self, catalog: &Catalog, most_vertices: usize) -> Result<World, WorldError> {
        let Self { name, source, json } = self;
        if !is_name(name) {
            return Err(self.error(format!("`{name}` is no name; allowed: {NAME}")));
        }
        let json = json.as_ref().map_err(|detail| self.error(detail.clone()))?;
        let world = World::read(name, source.clone(), json, catalog, most_vertices);
        world.map_err(|error| self.error(with_path(error, name)))
    }
}

/// The text of an error, whose faults begin with `worlds.NAME`.
pub(crate) fn with_path(error: Error, name: &str) -> String {
    match error {
        Error::Invalid(faults) => {
            let faults = faults.rename(|field| format!("worlds.{name}.{field}"));
            Error::from(faults).to_string()
        }
        error => error.to_string(),
    }
}

/// A file as JSON.
fn read(path: &Path) -> Result<String, String> {
    let text = bounded_file::read_text(path, DOCUMENT_BYTES).map_err(|error| error.to_string())?;
    if path.extension().is_some_and(|ending| ending == "json") {
        return Ok(text);
    }
    let table: toml::Table = text
        .parse()
        .map_err(|error: toml::de::Error| error.to_string())?;
    serde_json::to_string(&table).map_err(|error| error.to_string())
}
