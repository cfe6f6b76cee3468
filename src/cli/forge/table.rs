//! `strew forge` itself: makes a table of the plane or, with `--space`, of points in space, judges it, writes it.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow};
use strew_config::bounded_file;
use strew_core::Alpha;
use strew_forge::{
    Checkpoint, DEFAULT_SEED, Estimate, ForgeError, Job, Prospect, Target, file_name, forge,
    resume,
    space::{self, SpaceEstimate, SpaceJob, SpaceProfile, table_file_name},
};
use strew_query::{DEFAULT_ALPHA, DEFAULT_PROFILE};

use super::{Checkpoints, Made, Work};
use crate::cli::{Failure, refuse};

/// The most bytes of a file with a curve.
const MAX_TARGET_BYTES: u64 = 1 << 20;

/// The half-width R of the map of a table of the plane.
const DEFAULT_RADIUS: u32 = 49;

/// Flags of a new table.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct TableArgs {
    /// The noise profile.
    #[arg(long, default_value = DEFAULT_PROFILE)]
    profile: String,
    /// The number alpha.
    #[arg(long, default_value = DEFAULT_ALPHA)]
    alpha: Alpha,
    /// Make a table of points in space: three dimensions. Its profiles are blue and spaced.
    #[arg(long, conflicts_with = "target")]
    space: bool,
    /// The half-width R of the map in grid units [default: 49; in space 16]. In the plane 49 is S, 100 M,
    /// 200 L; in space 16 has 21 intervals and 20 has 27 at the default alpha, and 22 is the largest.
    #[arg(long, value_name = "R")]
    radius: Option<u32>,
    /// The seed of the random start [default: 17; in space 1].
    #[arg(long)]
    seed: Option<u64>,
    /// A radial power curve to follow. Either lines of two columns, frequency and power, joined by
    /// straight pieces; or TOML: `[[piece]]` with `from` and `to`, each piece beginning at the end of the
    /// one before, and `power = P` (level), `power = [P0, P1]` (straight) or
    /// `law = { power = P, at = N, exponent = E }`, which is P (nu/N)^E. Beyond the end the power is 1.
    /// --profile then names the new profile.
    #[arg(long, value_name = "FILE", requires = "profile")]
    target: Option<PathBuf>,
}

impl TableArgs {
    fn job(&self, steps: Option<u32>) -> Result<Job, Failure> {
        Ok(Job {
            alpha: self.alpha,
            radius: self.radius.unwrap_or(DEFAULT_RADIUS),
            profile: self.profile.clone(),
            seed: self.seed.unwrap_or(DEFAULT_SEED),
            target: self.target()?,
            steps,
        })
    }

    fn target(&self) -> Result<Option<Target>, Failure> {
        let Some(file) = &self.target else {
            return Ok(None);
        };
        let text = bounded_file::read_text(file, MAX_TARGET_BYTES);
        let text = text.with_context(|| format!("cannot read {}", file.display()))?;
        let target = text
            .parse()
            .with_context(|| format!("{} is not a power curve", file.display()));
        target.map(Some).map_err(Failure::Usage)
    }
}

/// Makes a table.
pub(super) fn run(
    args: &TableArgs,
    steps: Option<u32>,
    work: &Work,
    checkpoints: &Checkpoints,
) -> Result<(), Failure> {
    if args.space {
        let job = job_in_space(&args.profile, args.alpha, args.radius, args.seed, steps)?;
        return run_in_space(&job, work, checkpoints);
    }
    let job = args.job(steps)?;
    let path = work.path(&file_name(&job.profile, job.alpha, job.radius))?;
    let pool = work.pool()?;
    let estimate = pool.install(|| job.estimate()).map_err(Failure::usage)?;
    let kept = Checkpoints::path(&path);
    let is_of = |found: &Checkpoint| found.is_of(&job);
    let found = pool.install(|| checkpoints.found(&kept, work.quiet, is_of))?;
    if !work.quiet {
        announce(&path, &job.prospect(), &estimate);
        if let Some(found) = &found {
            let (steps, from) = (found.steps(), kept.display());
            eprintln!(
                "resuming at step {steps} of {}, from {from}",
                estimate.steps
            );
        }
    }
    let watcher = checkpoints.watcher(&kept, work);
    let outcome = pool.install(|| match found {
        None => forge(&job, &watcher),
        Some(found) => resume(&job, found, &watcher),
    });
    let outcome = outcome.map_err(Failure::usage)?;
    watcher.finish();
    if outcome.interrupted {
        let text = work.interrupted(&path, &outcome.table, &watcher)?;
        return Err(Failure::Interrupted(anyhow!(text)));
    }
    let nearness = outcome.nearness.as_ref().map(|near| {
        let met = if outcome.accepted { "met" } else { "missed" };
        format!("the target is {met}: {near}")
    });
    let (table, complaints) = (&outcome.table, &outcome.complaints);
    work.conclude(
        &path,
        "table",
        table,
        outcome.accepted,
        nearness,
        complaints,
    )?;
    Checkpoints::remove(&kept)
}

/// Announces the work, and whether it can succeed.
fn announce(path: &Path, prospect: &Prospect, estimate: &Estimate) {
    eprintln!(
        "forging {}: {} blocks, {} steps over {} pairs, judged on {} points; about {:.0} s",
        path.display(),
        prospect.blocks(),
        estimate.steps,
        estimate.pairs,
        estimate.measured_points,
        estimate.time.as_secs_f64().max(1.0)
    );
    if let Some(doubt) = prospect.doubt() {
        eprintln!("warning: the table will probably be rejected: {doubt}");
    }
    if let Some(least) = estimate.correlation.filter(|least| least.is_impossible()) {
        eprintln!(
            "warning: no point set has exactly this power curve: its pair correlation would be \
             {:.2} at distance {:.2} (in mean spacings); the forge looks for the nearest one",
            least.g, least.r
        );
    }
}

/// The job of a table of points in space. What the flags leave open is as in the shipped tables.
fn job_in_space(
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
fn run_in_space(job: &SpaceJob, work: &Work, checkpoints: &Checkpoints) -> Result<(), Failure> {
    let usual = table_file_name(job.profile.name(), job.alpha, job.radius);
    let path = work.path(&usual)?;
    let pool = work.pool()?;
    let estimate = pool.install(|| job.estimate()).map_err(Failure::usage)?;
    let kept = Checkpoints::path(&path);
    let is_of = |found: &Checkpoint| found.is_of_space(job);
    let found = checkpoints.found(&kept, work.quiet, is_of)?;
    if !work.quiet {
        announce_in_space(&path, &estimate, work.threads());
        if let Some(found) = &found {
            let (steps, of, from) = (found.steps(), estimate.steps, kept.display());
            eprintln!("resuming at step {steps} of {of}, from {from}");
        }
    }
    let watcher = checkpoints.watcher(&kept, work);
    let outcome = pool.install(|| match found {
        None => space::forge(job, &watcher),
        Some(found) => space::resume(job, found, &watcher),
    });
    let outcome = outcome.map_err(Failure::usage)?;
    watcher.finish();
    if outcome.interrupted {
        let text = work.interrupted(&path, &outcome.table, &watcher)?;
        return Err(Failure::Interrupted(anyhow!(text)));
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
    fn write(&self, path: &Path) -> Result<String, ForgeError> {
        space::write_table(path, self)?;
        Ok(self.digest().to_string())
    }
}

/// Announces the work.
fn announce_in_space(path: &Path, estimate: &SpaceEstimate, threads: usize) {
    eprintln!(
        "forging {}: {} blocks, {} steps, judged on {} points; about {:.0} s on {threads} threads",
        path.display(),
        estimate.blocks,
        estimate.steps,
        estimate.measured_points,
        estimate.time.as_secs_f64().max(1.0),
    );
}
