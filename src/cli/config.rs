//! `strew config`, and the flags that change settings.

use std::path::PathBuf;

use anyhow::Context as _;

use super::{Failure, output};
use crate::config::{Config, ConfigError, Layers};

/// Flags that change settings, shared by all commands that have any.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub(crate) struct Args {
    /// A file with settings, in TOML.
    #[arg(long, value_name = "FILE", env = "STREW_CONFIG")]
    config: Option<PathBuf>,
    /// A folder whose *.strew tables are loaded besides the built-in ones.
    #[arg(long, value_name = "DIR")]
    tables: Option<String>,
    /// Any setting, such as limits.max_points=1000.
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
        let merged = self.settings.merge(self.listen.as_deref());
        merged.map_err(|error| Failure::Usage(error.into()))
    }
}

impl Args {
    /// The flags of a command that has none: variables still count.
    pub(super) fn of_environment() -> Self {
        Self {
            config: std::env::var_os("STREW_CONFIG").map(PathBuf::from),
            ..Self::default()
        }
    }

    /// The merged settings.
    pub(crate) fn merged(&self) -> Result<Config, Failure> {
        self.merge(None)
            .map_err(|error| Failure::Usage(error.into()))
    }

    fn merge(&self, listen: Option<&str>) -> Result<Config, ConfigError> {
        let mut layers = Layers::new()?;
        if let Some(file) = &self.config {
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
        layers.finish()
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
