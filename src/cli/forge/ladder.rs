//! `strew forge --ladder-of TABLE`: makes a ladder for a table, judges it, writes the table with it.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use strew_forge::{Checkpoint, LadderJob, file_name, ladder, read_table};

use super::work::{Checkpoints, Work};
use crate::cli::Failure;

/// Flags of a ladder.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct LadderArgs {
    /// Make a ladder for this table instead of a new table: displacements for thinned sets. Its vectors
    /// do not change.
    #[arg(long, value_name = "TABLE", conflicts_with_all = ["profile", "alpha", "radius", "seed", "target"])]
    pub(super) ladder_of: Option<PathBuf>,
    /// Levels of the ladder for each halving of the share of points.
    #[arg(long, default_value_t = 16, requires = "ladder_of")]
    per_octave: u32,
    /// How often the share halves along the ladder.
    #[arg(long, default_value_t = 6, requires = "ladder_of")]
    octaves: u32,
}

/// Makes the ladder of a table file.
pub(super) fn run(
    args: &LadderArgs,
    of: &Path,
    steps: Option<u32>,
    work: &Work,
    checkpoints: &Checkpoints,
) -> Result<(), Failure> {
    let table = read_table(of).map_err(Failure::usage)?;
    let job = LadderJob {
        per_octave: args.per_octave,
        octaves: args.octaves,
        steps: steps.unwrap_or(LadderJob::default().steps),
    };
    let usual = file_name(table.profile(), table.alpha(), table.map().radius());
    let path = work.path(&usual)?;
    let kept = Checkpoints::path(&path);
    let found = match checkpoints.restart {
        true => None,
        false => Checkpoint::read_file(&kept).map_err(Failure::usage)?,
    };
    let watcher = checkpoints.watcher(&kept, work);
    let outcome = work
        .pool()?
        .install(|| ladder(&table, &job, found, &watcher));
    watcher.finish();
    let outcome = outcome.map_err(Failure::usage)?;
    if outcome.interrupted {
        let resumes = format!("; the same command resumes from {}", kept.display());
        let resumes = if watcher.has_kept() { &*resumes } else { "" };
        return Err(Failure::Interrupted(anyhow!("interrupted{resumes}")));
    }
    let made = ("ladder", &outcome.table);
    work.conclude(&path, made, outcome.accepted, None, &outcome.complaints)?;
    work.show(&outcome.figures);
    Checkpoints::remove(&kept)
}
