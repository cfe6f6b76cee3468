//! Everything that queries may name: a catalog, and the worlds over it.

use std::{ops::Deref, sync::Arc};

use strew_catalog::{Catalog, Reload};
use strew_config::Config;

use crate::world::Worlds;

/// A catalog with the worlds over it, which were checked against its tables, fields and lists.
#[derive(Clone, Debug, Default)]
pub struct Assets {
    pub catalog: Catalog,
    pub worlds: Arc<Worlds>,
}

impl From<Catalog> for Assets {
    fn from(catalog: Catalog) -> Self {
        Self {
            catalog,
            worlds: Arc::default(),
        }
    }
}

impl Deref for Assets {
    type Target = Catalog;

    fn deref(&self) -> &Catalog {
        &self.catalog
    }
}

impl Assets {
    /// These assets with other worlds.
    pub fn with_worlds(self, worlds: Worlds) -> Self {
        let worlds = Arc::new(worlds);
        Self { worlds, ..self }
    }

    /// These worlds over another catalog: their digests follow.
    pub fn over(&self, catalog: Catalog) -> Self {
        let worlds = Arc::new(self.worlds.over(&catalog));
        Self { catalog, worlds }
    }

    /// The assets after reading the folders of tables, fields, lists and worlds again, and the changes.
    pub fn reload(&self, config: &Config) -> (Self, Reload) {
        let (after, mut reload) = self.catalog.reload_tables(config.tables.folder());
        let (names, changed) = match config.read_again() {
            Ok(read) => read,
            Err(error) => {
                let file = config.layers.files.last();
                reload.refuse_file(file.map(AsRef::as_ref), &error);
                // The earlier fields and worlds stay, including those of folders.
                return (self.over(after), reload);
            }
        };
        reload.at_next_start = changed;
        let after = after.reload_names(&names, &mut reload);
        let worlds = self.worlds.reload(&names.worlds, &after);
        let worlds = reload.take(|all| &mut all.worlds, worlds);
        (Self::from(after).with_worlds(worlds), reload)
    }
}
