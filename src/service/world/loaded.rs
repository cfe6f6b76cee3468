//! Loading worlds: from the configuration and from a folder, at the start and again.

use super::{Catalog, Error, World, Worlds};
use crate::{
    config::Worlds as Settings,
    service::named::{Changes, Found, NamedError, Places, Refused},
};

/// Where worlds are described.
fn places(settings: &Settings) -> Places<'_> {
    Places {
        section: "worlds",
        named: &settings.named,
        folder: settings.folder(),
        endings: &["json", "toml"],
        most_bytes: 4 << 20,
    }
}

/// Reads and checks a document.
fn check(
    found: &Found,
    json: &str,
    catalog: &Catalog,
    most_vertices: usize,
) -> Result<World, String> {
    let world = World::read(found, json, catalog, most_vertices);
    world.map_err(|error| with_path(error, &found.name))
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
    ) -> Result<Self, NamedError> {
        let none = Self {
            most_vertices,
            ..Self::default()
        };
        let (worlds, _, refused) = none.reload(settings, catalog);
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
    ) -> (Self, Changes, Vec<Refused<NamedError>>) {
        let digest = |world: &World| world.digest.clone();
        let before = self.over(catalog);
        let read = places(settings).over(&before.entries, digest, |found, json| {
            check(found, json, catalog, self.most_vertices)
        });
        let (after, refused) = match read {
            Ok((entries, refused)) => (Self { entries, ..*self }, refused),
            // All of them stay.
            Err(error) => (before, vec![(error, None)]),
        };
        let changes = Changes::between(&self.entries, &after.entries, digest);
        (after, changes, refused)
    }

    /// Reads every world by itself.
    ///
    /// # Errors
    /// If the folder cannot be listed.
    pub fn each(
        settings: &Settings,
        catalog: &Catalog,
        most_vertices: usize,
    ) -> Result<Vec<(Found, Result<World, NamedError>)>, NamedError> {
        places(settings).each(|found, json| check(found, json, catalog, most_vertices))
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
