//! `strew config`, the flags that change settings, and the loading of what settings name. Settings that cannot be
//! loaded are wrong usage.

use std::path::PathBuf;

use anyhow::{Context as _, anyhow};
use strew_catalog::{Catalog, except::Lists, field::Fields};
use strew_config::{Config, ConfigError, Layers};
use strew_error::Error;
use strew_plan::Planned;
use strew_query::{Assets, Draft, Options, Worlds};

use super::{Failure, output};

/// The settings that a command uses: sections with a dot, and keys. Flags for other settings are refused.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Uses(&'static [&'static [&'static str]]);

const NAMED: &[&str] = &["tables.", "fields.", "except."];
const LISTS: &[&str] = &["limits.max_points"];
const PLANS: &[&str] = &["worlds.", "limits.max_rows", "limits.max_vertices"];
const BLOCKS: &[&str] = &["limits.block_bytes", "workers.threads"];

impl Uses {
    pub(crate) const ALL: Self = Self(&[&[""]]);
    pub(crate) const LOADED: Self = Self(&[NAMED]);
    pub(crate) const LISTS: Self = Self(&[NAMED, LISTS]);
    pub(crate) const QUERIES: Self = Self(&[NAMED, LISTS, PLANS]);
    pub(crate) const POINTS: Self = Self(&[NAMED, LISTS, PLANS, BLOCKS]);
}

/// The flags that change settings, shared by the commands that use settings.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub(crate) struct Args {
    /// A file with settings, in TOML, laid over the one that the variable STREW_CONFIG names.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// A folder with *.strew tables to load beside the built-in ones.
    #[arg(long, value_name = "DIR")]
    tables: Option<String>,
    /// A setting that the command uses, such as tables.embedded=false. The last one of a key applies.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// The flags of commands that serve, or show what would be served.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub(crate) struct Served {
    /// The address and port to serve on; port 0 for any free one.
    #[arg(long, value_name = "ADDR")]
    listen: Option<String>,
    #[command(flatten)]
    settings: Args,
}

impl Served {
    pub(crate) fn merged(&self) -> Result<Config, Failure> {
        let merged = self.settings.merge(Uses::ALL, self.listen.as_deref());
        merged.map_err(Failure::usage)
    }

    pub(crate) fn must_be_unused(&self, why: &str) -> Result<(), Failure> {
        let listen = self.listen.as_ref().map(|_| "--listen");
        self.settings.must_be_unused(listen, why)
    }
}

impl Args {
    /// The merged settings. Flags may set only those that are used.
    pub(crate) fn merged(&self, uses: Uses) -> Result<Config, Failure> {
        self.merge(uses, None).map_err(Failure::usage)
    }

    /// Refuses these flags, and one more, where settings have no effect; `why` is the reason.
    fn must_be_unused(&self, more: Option<&str>, why: &str) -> Result<(), Failure> {
        let config = self.config.as_ref().map(|_| "--config");
        let tables = self.tables.as_ref().map(|_| "--tables");
        let set = self.set.first().map(|_| "--set");
        match more.or(config).or(tables).or(set) {
            None => Ok(()),
            Some(flag) => Err(Failure::Usage(anyhow!(
                "{flag} has no effect: {why}; leave out the flags of settings"
            ))),
        }
    }

    fn merge(&self, uses: Uses, listen: Option<&str>) -> Result<Config, ConfigError> {
        let mut layers = Layers::new()?;
        let variable = std::env::var_os("STREW_CONFIG").map(PathBuf::from);
        for file in variable.iter().chain(&self.config) {
            layers = layers.file(file)?;
        }
        // A variable that is not Unicode cannot be one of ours in name or value.
        let variables = std::env::vars_os().filter_map(|(name, value)| {
            Some((name.into_string().ok()?, value.into_string().ok()?))
        });
        layers = layers.environment(variables)?;
        for assignment in &self.set {
            layers = layers.assignment(assignment)?;
        }
        if let Some(listen) = listen {
            layers = layers.flag("--listen", "server.listen", listen)?;
        }
        if let Some(folder) = &self.tables {
            layers = layers.flag("--tables", "tables.folder", folder)?;
        }
        layers.only(&uses.0.concat())?.finish()
    }
}

pub(super) fn run(args: &Served) -> Result<(), Failure> {
    let text = args
        .merged()?
        .to_toml()
        .context("cannot write the settings")?;
    output::print(&text)
}

/// The tables.
pub(super) fn catalog(config: &Config) -> Result<Catalog, Failure> {
    let tables = &config.tables;
    Catalog::preloading(tables.preload_bytes, tables.embedded, tables.folder())
        .map_err(Failure::usage)
}

/// The tables, fields and lists.
pub(super) fn tables(config: &Config) -> Result<Catalog, Failure> {
    let lists = Lists::load(&config.except).map_err(Failure::usage)?;
    let fields = Fields::load(&config.fields).map_err(Failure::usage)?;
    Ok(catalog(config)?.with_fields(fields).with_except(lists))
}

/// Adds the worlds.
pub(super) fn with_worlds(config: &Config, catalog: Catalog) -> Result<Assets, Failure> {
    let worlds = Worlds::load(&config.worlds, &catalog, config.limits.max_vertices);
    Ok(Assets::from(catalog).with_worlds(worlds.map_err(Failure::usage)?))
}

/// The tables, fields, lists and worlds.
pub(super) fn assets(config: &Config) -> Result<Assets, Failure> {
    with_worlds(config, tables(config)?)
}

/// Checks and plans a query.
pub(super) fn planned(
    config: &Config,
    draft: &Draft,
    assets: &Assets,
) -> Result<(Planned, Options), Error> {
    let (query, options) = draft.check(assets, config.limits.max_vertices)?;
    Ok((Planned::at_once(query, &config.limits)?, options))
}

/// A pool of this number of threads; 0 for one per core.
pub(super) fn pool(threads: usize) -> anyhow::Result<rayon::ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().context("cannot start threads")
}
