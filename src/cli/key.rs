//! `strew key`: keys for clients.

use anyhow::Context as _;
use strew_config::name::{ALLOWED, is_name};
use strew_service::access;

use super::{Failure, must_be_within, output, refuse};

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
    /// The name of the key: 1 to 64 letters, digits, _, - and .
    #[arg(value_name = "NAME")]
    name: String,
    /// Allow the key to administer the daemon, such as to reload tables.
    #[arg(long)]
    admin: bool,
    /// The greatest number of points of an answer.
    #[arg(long, value_name = "POINTS", value_parser = clap::value_parser!(u64).range(1..))]
    max_points: Option<u64>,
    /// The greatest number of answers at a time.
    #[arg(long, value_name = "STREAMS", value_parser = clap::value_parser!(u32).range(1..))]
    max_streams: Option<u32>,
    /// The greatest number of points per second, 0.001 or more.
    #[arg(long, value_name = "POINTS")]
    points_per_second: Option<f64>,
}

pub(super) fn run(command: &Command) -> Result<(), Failure> {
    let Command::New(new) = command;
    if !is_name(&new.name) {
        refuse!("NAME is {:?}; allowed: {}", new.name, ALLOWED);
    }
    if let Some(rate) = new.points_per_second {
        must_be_within("--points-per-second", rate, [1e-3, 1e15])?;
    }
    let (key, hash) = access::new_key().context("the system has no random numbers")?;
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
    eprintln!("the key, which is stored nowhere and cannot be shown again:\n{key}");
    Ok(())
}
