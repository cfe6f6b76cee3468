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
    /// Where to serve: address and port; port 0 for any free one.
    #[arg(long, value_name = "ADDR")]
    listen: Option<String>,
    /// A folder whose *.strew tables are loaded besides the built-in ones.
    #[arg(long, value_name = "DIR")]
    tables: Option<String>,
    /// Any setting, such as limits.max_points=1000.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

impl Args {
    /// The merged settings.
    pub(crate) fn merged(&self) -> Result<Config, Failure> {
        self.merge().map_err(|error| Failure::Usage(error.into()))
    }

    fn merge(&self) -> Result<Config, ConfigError> {
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
        if let Some(listen) = &self.listen {
            layers = layers.flag("--listen", "server.listen", listen)?;
        }
        if let Some(folder) = &self.tables {
            layers = layers.flag("--tables", "tables.folder", folder)?;
        }
        layers.finish()
    }
}

/// Prints the merged settings.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let text = args
        .merged()?
        .to_toml()
        .context("cannot write the settings")?;
    output::print(&text)
}
