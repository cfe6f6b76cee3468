//! `strew forge` itself: makes a table, judges it, writes it.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow};
use strew_config::bounded_file;
use strew_core::Alpha;
use strew_forge::{
    Checkpoint, DEFAULT_SEED, Estimate, Job, Outcome, Prospect, Target, file_name, forge, resume,
};
use strew_query::{DEFAULT_ALPHA, DEFAULT_PROFILE};

use super::work::{Checkpoints, Work, write};
use crate::cli::{Failure, refuse, watcher::Watcher};

/// The most bytes of a file with a curve.
const MAX_TARGET_BYTES: u64 = 1 << 20;

/// Flags of a new table.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct TableArgs {
    /// The noise profile.
    #[arg(long, default_value = DEFAULT_PROFILE)]
    profile: String,
    /// The number alpha.
    #[arg(long, default_value = DEFAULT_ALPHA, allow_hyphen_values = true)]
    alpha: Alpha,
    /// The half-width R of the map in grid units: 49 (S), 100 (M), 200 (L) or another.
    #[arg(long, default_value_t = 49)]
    radius: u32,
    /// The seed of the random start.
    #[arg(long, default_value_t = DEFAULT_SEED)]
    seed: u64,
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
            radius: self.radius,
            profile: self.profile.clone(),
            seed: self.seed,
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
    let job = args.job(steps)?;
    let path = work.path(&file_name(&job.profile, job.alpha, job.radius))?;
    let pool = work.pool()?;
    let estimate = pool.install(|| job.estimate()).map_err(Failure::usage)?;
    let kept = Checkpoints::path(&path);
    let found = match checkpoints.restart {
        true => None,
        false => pool.install(|| found(&job, &kept, work.quiet))?,
    };
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
        return interrupted(work, &path, &outcome, &watcher);
    }
    let nearness = outcome.nearness.as_ref().map(|near| {
        let met = if outcome.accepted { "met" } else { "missed" };
        format!("the target is {met}: {near}")
    });
    let (made, complaints) = (("table", &outcome.table), &outcome.complaints);
    work.conclude(&path, made, outcome.accepted, nearness, complaints)?;
    Checkpoints::remove(&kept)
}

/// The checkpoint to resume from, if there is one of this job.
fn found(job: &Job, path: &Path, quiet: bool) -> Result<Option<Checkpoint>, Failure> {
    let advice = "--restart begins anew and replaces it";
    let found = Checkpoint::read_file(path)
        .map_err(|error| Failure::Usage(anyhow!("{error}; {advice}")))?;
    let Some(found) = found else {
        return Ok(None);
    };
    match found.is_of(job) {
        Ok(()) => Ok(Some(found)),
        Err(error) if found.is_optimized() => {
            // It is that of a rejected table, and spares only the steps of that job.
            if !quiet {
                eprintln!("beginning anew: {}: {error}", path.display());
            }
            Ok(None)
        }
        Err(error) => refuse!("{}: {error}; finish that job, or {advice}", path.display()),
    }
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

/// Reports where interrupted work can resume.
fn interrupted(
    work: &Work,
    path: &Path,
    outcome: &Outcome,
    watcher: &Watcher,
) -> Result<(), Failure> {
    let mut text = String::from("interrupted");
    if work.keep_rejected {
        write(path, &outcome.table)?;
        text += &format!("; {} holds the best so far, not judged", path.display());
    }
    if watcher.has_kept() {
        let force = match work.keep_rejected {
            true => " with --force",
            false => "",
        };
        let kept = Checkpoints::path(path);
        text += &format!("; the same command{force} resumes from {}", kept.display());
    }
    Err(Failure::Interrupted(anyhow!(text)))
}
