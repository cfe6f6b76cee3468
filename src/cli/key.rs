//! `strew key`: keys for clients.

use anyhow::{Context as _, anyhow};

use super::{Failure, output};
use crate::{
    access,
    name::{ALLOWED, is_name},
};

/// Commands about keys.
#[derive(Debug, clap::Subcommand)]
pub(super) enum Command {
    /// Make a key: print its entry for access.keys_file on standard output, and the key itself, once,
    /// on standard error.
    New(New),
}

/// Flags of `strew key new`.
#[derive(Debug, clap::Args)]
pub(super) struct New {
    /// What the key is called: 1 to 64 letters, digits, _, - and .
    #[arg(value_name = "NAME")]
    name: String,
    /// Whether it may tell the daemon what to do, such as to read tables again.
    #[arg(long)]
    admin: bool,
    /// The most points of one answer.
    #[arg(long, value_name = "POINTS", value_parser = clap::value_parser!(u64).range(1..))]
    max_points: Option<u64>,
    /// The most answers under way at once.
    #[arg(long, value_name = "STREAMS", value_parser = clap::value_parser!(u32).range(1..))]
    max_streams: Option<u32>,
    /// How many points may be taken in a second, from 0.001 on.
    #[arg(long, value_name = "POINTS")]
    points_per_second: Option<f64>,
}

/// Runs a command.
pub(super) fn run(command: &Command) -> Result<(), Failure> {
    let Command::New(new) = command;
    if !is_name(&new.name) {
        return Err(Failure::Usage(anyhow!(
            "NAME is {:?}; allowed: {}",
            new.name,
            ALLOWED
        )));
    }
    if let Some(value) = new.points_per_second
        && !(1e-3..=1e15).contains(&value)
    {
        return Err(Failure::Usage(anyhow!(
            "--points-per-second is {value}; allowed: 0.001 to 1e15"
        )));
    }
    let (key, hash) = access::new_key().context("the system gives no random numbers")?;
    let mut entry = format!("[[key]]\nname = \"{}\"\nhash = \"{hash}\"\n", new.name);
    let mut line = |name: &str, value: Option<String>| {
        if let Some(value) = value {
            entry += &format!("{name} = {value}\n");
        }
    };
    line("admin", new.admin.then(|| "true".into()));
    line("max_points", new.max_points.map(|v| v.to_string()));
    line("max_streams", new.max_streams.map(|v| v.to_string()));
    let rate = new.points_per_second.map(|v| format!("{v:?}"));
    line("points_per_second", rate);
    output::print(&entry)?;
    eprintln!("the key, which is kept nowhere and cannot be shown again:\n{key}");
    Ok(())
}
