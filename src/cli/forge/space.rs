//! `strew forge --space`: makes a table of points in space, judges it, writes it.

use std::path::Path;

use anyhow::anyhow;
use strew_core::Alpha;
use strew_forge::{
    Checkpoint,
    space::{
        SpaceEstimate, SpaceJob, SpaceOutcome, SpaceProfile, forge, resume, table_file_name,
        write_table,
    },
};

use super::work::{Checkpoints, Made, Work};
use crate::cli::{Failure, refuse, watcher::Watcher};

/// The job of a table of points in space. What the flags leave open is as in the shipped tables.
pub(super) fn job(
    profile: &str,
    alpha: Alpha,
    radius: Option<u32>,
    seed: Option<u64>,
    steps: Option<u32>,
) -> Result<SpaceJob, Failure> {
    let Some(profile) = SpaceProfile::named(profile) else {
        let names = SpaceProfile::ALL.map(SpaceProfile::name).join(", ");
        refuse!(
            "--profile {profile}: no profile of points in space; allowed with --space: {names}"
        );
    };
    let default = SpaceJob::new(profile);
    Ok(SpaceJob {
        alpha,
        radius: radius.unwrap_or(default.radius),
        seed: seed.unwrap_or(default.seed),
        steps,
        ..default
    })
}

/// Makes a table.
pub(super) fn run(job: &SpaceJob, work: &Work, checkpoints: &Checkpoints) -> Result<(), Failure> {
    let usual = table_file_name(job.profile.name(), job.alpha, job.radius);
    let path = work.path(&usual)?;
    let pool = work.pool()?;
    let estimate = pool.install(|| job.estimate()).map_err(Failure::usage)?;
    let kept = Checkpoints::path(&path);
    let is_of = |found: &Checkpoint| found.is_of_space(job);
    let found = checkpoints.found(&kept, work.quiet, is_of)?;
    if !work.quiet {
        announce(&path, &estimate, work.threads());
        if let Some(found) = &found {
            let (steps, of, from) = (found.steps(), estimate.steps, kept.display());
            eprintln!("resuming at step {steps} of {of}, from {from}");
        }
    }
    let watcher = checkpoints.watcher(&kept, work);
    let outcome = pool.install(|| match found {
        None => forge(job, &watcher),
        Some(found) => resume(job, found, &watcher),
    });
    let outcome = outcome.map_err(Failure::usage)?;
    watcher.finish();
    if outcome.interrupted {
        return interrupted(work, &path, &outcome, &watcher);
    }
    let (is_accepted, complaints) = (outcome.accepted, &outcome.complaints);
    work.conclude(
        &path,
        "table",
        &outcome.table,
        is_accepted,
        None,
        complaints,
    )?;
    work.show(&outcome.table.provenance().figures);
    Checkpoints::remove(&kept)
}

impl Made for strew_core::space::Table {
    fn write(&self, path: &Path) -> Result<String, strew_forge::ForgeError> {
        write_table(path, self)?;
        Ok(self.digest().to_string())
    }
}

/// Announces the work.
fn announce(path: &Path, estimate: &SpaceEstimate, threads: usize) {
    eprintln!(
        "forging {}: {} blocks, {} steps, judged on {} points; about {:.0} s on {threads} threads",
        path.display(),
        estimate.blocks,
        estimate.steps,
        estimate.measured_points,
        estimate.time.as_secs_f64().max(1.0),
    );
}

/// Reports where interrupted work can resume.
fn interrupted(
    work: &Work,
    path: &Path,
    outcome: &SpaceOutcome,
    watcher: &Watcher,
) -> Result<(), Failure> {
    let text = work.interrupted(path, &outcome.table, watcher)?;
    Err(Failure::Interrupted(anyhow!(text)))
}
