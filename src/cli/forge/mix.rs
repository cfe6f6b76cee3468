//! `strew forge mix`: makes kinds for a table, judges them, writes the table with them.

use std::{path::Path, time::Duration};

use anyhow::anyhow;
use strew_catalog::{Catalog, Dimension, Key};
use strew_core::{Alpha, Table, map::Size, table::Shares};
use strew_forge::{MixJob, mix, mix_file_name, read_table};
use strew_query::{DEFAULT_ALPHA, DEFAULT_PROFILE};

use super::{Watcher, Work};
use crate::cli::{Failure, refuse};

/// Flags of `strew forge mix`. Equal flags make equal tables, bit by bit, on every machine.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The shares of the kinds, joined by colons, such as 1:3, in any order.
    #[arg(long, value_name = "N:N:…")]
    shares: Shares,
    /// Also move the points, so that each kind is as blue as a set of its own.
    #[arg(long)]
    joint: bool,
    /// The table to make kinds for: the profile of a built-in table, or a file.
    #[arg(long, value_name = "PROFILE|FILE", default_value = DEFAULT_PROFILE)]
    table: String,
    /// The map of the built-in table: s, m or l.
    #[arg(long, default_value = "m")]
    map: Size,
    /// Steps of the descent that moves points [default: 240].
    #[arg(long, requires = "joint")]
    steps: Option<u32>,
    #[command(flatten)]
    work: Work,
}

impl Args {
    fn job(&self) -> MixJob {
        let shares = self.shares.clone();
        let mut job = match self.joint {
            true => MixJob::joint(shares),
            false => MixJob::labels(shares),
        };
        job.steps = self.steps.unwrap_or(job.steps);
        job
    }

    /// The table to make kinds for.
    fn of(&self) -> Result<Table, Failure> {
        let path = Path::new(&self.table);
        let is_file = path.exists() || path.components().count() > 1 || path.extension().is_some();
        if is_file {
            return read_table(path).map_err(Failure::usage);
        }
        let catalog = Catalog::load(true, None).map_err(Failure::other)?;
        let alpha: Alpha = DEFAULT_ALPHA.parse().map_err(Failure::other)?;
        let key = Key {
            dimension: Dimension::Plane,
            profile: self.table.as_str().into(),
            alpha,
            size: self.map,
            mix: None,
        };
        let Some(entry) = catalog.entry(&key) else {
            let built_in = { catalog.entries() }
                .filter(|entry| entry.key.alpha == alpha)
                .map(|entry| format!("{} {}", entry.key.profile, entry.key.size))
                .collect::<Vec<_>>();
            refuse!(
                "--table {} --map {}: no built-in table and no file; there are {}",
                self.table,
                self.map,
                built_in.join(", ")
            );
        };
        entry.table().map_err(Failure::other)
    }
}

/// Makes the mix.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let (table, job, work) = (args.of()?, args.job(), &args.work);
    let path = work.path(&mix_file_name(&table, &job))?;
    // It takes seconds, so there are no checkpoints.
    let watcher = Watcher::new(&path, Duration::MAX, work.quiet);
    let outcome = work.pool()?.install(|| mix(&table, &job, &watcher));
    watcher.finish();
    let Some(outcome) = outcome.map_err(Failure::usage)? else {
        return Err(Failure::Interrupted(anyhow!("interrupted")));
    };
    let (table, complaints) = (&outcome.table, &outcome.complaints);
    work.conclude(&path, "mix", table, outcome.accepted, None, complaints)?;
    work.show(&outcome.figures);
    Ok(())
}
