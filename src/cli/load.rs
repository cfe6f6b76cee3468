//! Loads what the settings of a command name. Settings that cannot be loaded are wrong usage.

use strew_catalog::{Catalog, except::Lists, field::Fields};
use strew_config::Config;
use strew_error::Error;
use strew_plan::Planned;
use strew_query::{Assets, Draft, Options, Worlds};

use super::Failure;

/// The loading of what settings name.
pub(super) trait Load {
    /// The tables.
    fn catalog(&self) -> Result<Catalog, Failure>;

    /// The tables, fields and lists.
    fn tables(&self) -> Result<Catalog, Failure>;

    /// The fields.
    fn loaded_fields(&self) -> Result<Fields, Failure>;

    /// Adds the worlds.
    fn with_worlds(&self, catalog: Catalog) -> Result<Assets, Failure>;

    /// Checks and plans a query.
    fn planned(&self, draft: &Draft, assets: &Assets) -> Result<(Planned, Options), Error>;
}

impl Load for Config {
    fn catalog(&self) -> Result<Catalog, Failure> {
        let tables = &self.tables;
        Catalog::preloading(tables.preload_bytes, tables.embedded, tables.folder())
            .map_err(Failure::usage)
    }

    fn tables(&self) -> Result<Catalog, Failure> {
        let catalog = self.catalog()?;
        let lists = Lists::load(&self.except).map_err(Failure::usage)?;
        Ok(catalog
            .with_fields(self.loaded_fields()?)
            .with_except(lists))
    }

    fn loaded_fields(&self) -> Result<Fields, Failure> {
        Fields::load(&self.fields).map_err(Failure::usage)
    }

    fn with_worlds(&self, catalog: Catalog) -> Result<Assets, Failure> {
        let worlds = Worlds::load(&self.worlds, &catalog, self.limits.max_vertices);
        Ok(Assets::from(catalog).with_worlds(worlds.map_err(Failure::usage)?))
    }

    fn planned(&self, draft: &Draft, assets: &Assets) -> Result<(Planned, Options), Error> {
        let (query, options) = draft.check(assets, self.limits.max_vertices)?;
        Ok((Planned::at_once(query, &self.limits)?, options))
    }
}
