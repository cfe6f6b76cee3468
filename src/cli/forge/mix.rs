//! `strew forge mix`: makes kinds for a table, judges them, writes the table with them.

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use anyhow::{Context as _, anyhow};
use strew_core::{
    Table,
    map::Size,
    table::{Figures, Shares},
};
use strew_forge::{ForgeError, MixJob, mix, mix_file_name, read_table, write_table};

use super::gravest;
use crate::{
    cli::{Failure, output, watcher::Watcher},
    service::{
        catalog::{Catalog, Key},
        query::{DEFAULT_ALPHA, DEFAULT_PROFILE},
    },
};

/// Flags of `strew forge mix`. Equal flags make equal tables, bit by bit, on every machine.
#[derive(Debug, clap::Args)]
pub(in crate::cli) struct Args {
    /// The shares of the kinds, joined by colons, such as 1:3, in any order.
    #[arg(long, value_name = "N:N:…")]
    shares: Shares,
    /// Also move the points, so that each kind is as blue as a set of its own. Without it points stay where they
    /// are.
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
    /// Threads to use; 0 for one per core. The table is the same with any number.
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// The file to write.
    #[arg(long, short, value_name = "FILE", conflicts_with = "out_dir")]
    output: Option<PathBuf>,
    /// A folder to write to, under the usual name [default: the current one].
    #[arg(long, value_name = "DIR")]
    out_dir: Option<PathBuf>,
    /// Replace a file that is there.
    #[arg(long)]
    force: bool,
    /// Write the table also if it misses a bound.
    #[arg(long)]
    keep_rejected: bool,
    /// Say nothing on standard error but errors.
    #[arg(long, short)]
    quiet: bool,
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
            return read_table(path).map_err(usage);
        }
        let catalog = Catalog::load(true, None).map_err(|e| Failure::Other(e.into()))?;
        let key = Key {
            profile: self.table.as_str().into(),
            alpha: DEFAULT_ALPHA
                .parse()
                .map_err(|e: strew_core::Error| Failure::Other(e.into()))?,
            size: self.map,
        };
        let Some(entry) = catalog.entry(&key) else {
            let built_in = catalog
                .entries()
                .filter(|entry| entry.key.alpha == key.alpha);
            let built_in =
                built_in.map(|entry| format!("{} {}", entry.key.profile, entry.key.size));
            let built_in = built_in.collect::<Vec<_>>().join(", ");
            let problem = anyhow!(
                "--table {} --map {}: no built-in table and no file; there are {built_in}",
                self.table,
                self.map
            );
            return Err(Failure::Usage(problem));
        };
        entry.table().map_err(|error| Failure::Other(error.into()))
    }
}

fn usage(error: ForgeError) -> Failure {
    Failure::Usage(error.into())
}

/// Makes the mix.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let (table, job) = (args.of()?, args.job());
    let usual = || {
        let folder = args.out_dir.clone().unwrap_or_default();
        folder.join(mix_file_name(&table, &job))
    };
    let path = args.output.clone().unwrap_or_else(usual);
    if path.exists() && !args.force {
        let problem = anyhow!("{} is there already; --force replaces it", path.display());
        return Err(Failure::Usage(problem));
    }
    output::check(&path)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads);
    let pool = pool.build().context("cannot start threads")?;
    // It takes seconds, so there are no checkpoints.
    let watcher = Watcher::new(&path, Duration::MAX, args.quiet);
    let outcome = pool.install(|| mix(&table, &job, &watcher));
    watcher.finish();
    let Some(outcome) = outcome.map_err(usage)? else {
        return Err(Failure::Interrupted(anyhow!("interrupted")));
    };
    let complaints = gravest(&outcome.complaints);
    if !outcome.accepted && !args.keep_rejected {
        return Err(Failure::Other(anyhow!(
            "the mix is rejected and not written (the same command with --keep-rejected writes it): {}",
            complaints.join("; ")
        )));
    }
    write_table(&path, &outcome.table).map_err(|error| Failure::Other(error.into()))?;
    output::print(&format!("{}  {}\n", outcome.table.digest(), path.display()))?;
    if !args.quiet {
        outcome.figures.iter().for_each(show);
    }
    for complaint in complaints {
        eprintln!("kept although rejected: {complaint}");
    }
    Ok(())
}

/// Prints what was measured on one set.
fn show(figures: &Figures) {
    let values = figures.values.iter();
    let values = values.map(|(name, value)| format!("{name} {value:.3e}"));
    let values = values.collect::<Vec<_>>().join(", ");
    eprintln!("{}: {values}", figures.subject);
}
