//! `strew config`, and the flags that change settings.

use std::path::PathBuf;

use anyhow::{Context as _, anyhow};

use super::{Failure, output};
use crate::config::{Config, ConfigError, Layers};

/// What the settings are called that a command uses: sections with a dot, and keys. Flags for others are refused.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Uses(&'static [&'static str]);

impl Uses {
    /// All settings, which daemons use.
    pub(crate) const ALL: Self = Self(&[""]);
    /// What is loaded by name.
    pub(crate) const LOADED: Self = Self(&["tables.", "fields.", "except."]);
    /// What lists are made with.
    pub(crate) const LISTS: Self = Self(&["tables.", "fields.", "except.", "limits.max_points"]);
    /// What queries are planned with.
    pub(crate) const QUERIES: Self = Self(&[
        "tables.",
        "fields.",
        "except.",
        "worlds.",
        "limits.max_points",
        "limits.max_rows",
        "limits.max_vertices",
    ]);
    /// What points are made with.
    pub(crate) const POINTS: Self = Self(&[
        "tables.",
        "fields.",
        "except.",
        "worlds.",
        "limits.max_points",
        "limits.max_rows",
        "limits.max_vertices",
        "limits.block_bytes",
        "workers.threads",
    ]);
}

/// Flags that change settings, shared by all commands that have any.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub(crate) struct Args {
    /// A file with settings, in TOML [default: the file that the variable STREW_CONFIG names, if it is set]
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// A folder whose *.strew tables are loaded besides the built-in ones.
    #[arg(long, value_name = "DIR")]
    tables: Option<String>,
    /// A setting that the command uses, such as tables.embedded=false; the last one of a key counts.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// The flags of commands that serve, or look at what would be served.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub(crate) struct Served {
    /// Where to serve: address and port; port 0 for any free one.
    #[arg(long, value_name = "ADDR")]
    listen: Option<String>,
    #[command(flatten)]
    settings: Args,
}

impl Served {
    /// The merged settings.
    pub(crate) fn merged(&self) -> Result<Config, Failure> {
        let merged = self.settings.merge(Uses::ALL, self.listen.as_deref());
        merged.map_err(|error| Failure::Usage(error.into()))
    }

    /// As [`Args::must_be_unused`].
    pub(crate) fn must_be_unused(&self, why: &str) -> Result<(), Failure> {
        let listen = self.listen.as_ref().map(|_| "--listen");
        self.settings.must_be_unused(listen, why)
    }
}

impl Args {
    /// The merged settings, of which flags may set those that are used.
    pub(crate) fn merged(&self, uses: Uses) -> Result<Config, Failure> {
        self.merge(uses, None)
            .map_err(|error| Failure::Usage(error.into()))
    }

    /// Refuses these flags, and one more, where settings have no effect, for a reason.
    fn must_be_unused(&self, more: Option<&str>, why: &str) -> Result<(), Failure> {
        let config = self.config.as_ref().map(|_| "--config");
        let tables = self.tables.as_ref().map(|_| "--tables");
        let set = self.set.first().map(|_| "--set");
        match more.or(config).or(tables).or(set) {
            None => Ok(()),
            Some(flag) => Err(Failure::Usage(anyhow!(
                "{flag} has no effect: {why}; allowed: no flags of settings"
            ))),
        }
    }

    fn merge(&self, uses: Uses, listen: Option<&str>) -> Result<Config, ConfigError> {
        let mut layers = Layers::new()?;
        let variable = std::env::var_os("STREW_CONFIG").map(PathBuf::from);
        if let Some(file) = self.config.as_ref().or(variable.as_ref()) {
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
        layers.only(uses.0)?.finish()
    }
}

/// Prints the merged settings.
pub(super) fn run(args: &Served) -> Result<(), Failure> {
    let text = args
        .merged()?
        .to_toml()
        .context("cannot write the settings")?;
    output::print(&text)
}
