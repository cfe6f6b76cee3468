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
        let names = match config.read_names() {
            Ok(names) => names,
            Err(error) => {
                let file = config.files.last().map(|file| file.display().to_string());
                reload.refuse_file(&file.unwrap_or_default(), &error);
                // The earlier fields and worlds stay, including those of folders.
                return (self.over(after), reload);
            }
        };
        let after = after.reload_names(&names, &mut reload);
        let (worlds, changes, refused) = self.worlds.reload(&names.worlds, &after);
        reload.worlds = changes;
        reload.refuse(refused);
        (Self::from(after).with_worlds(worlds), reload)
    }
}
