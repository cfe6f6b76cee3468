//! `strew forge`: makes a table, judges it, writes it.

use std::{
    path::PathBuf,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

use anyhow::{Context as _, anyhow};
use strew_core::Alpha;
use strew_forge::{
    DEFAULT_SEED, ForgeError, Job, Outcome, Stage, Target, Watch, file_name, forge, write_table,
};

use super::{Failure, progress::Progress};
use crate::service::query::{DEFAULT_ALPHA, DEFAULT_PROFILE};

/// Flags of `strew forge`. Equal jobs make equal tables, bit by bit, on every machine.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The noise profile.
    #[arg(long, default_value = DEFAULT_PROFILE)]
    profile: String,
    /// The number alpha.
    #[arg(long, default_value = DEFAULT_ALPHA, allow_hyphen_values = true)]
    alpha: String,
    /// The half-width R of the map in grid units: 49 (S), 100 (M), 200 (L) or another.
    #[arg(long, default_value_t = 49)]
    radius: u32,
    /// The seed of the random start.
    #[arg(long, default_value_t = DEFAULT_SEED)]
    seed: u64,
    /// A radial power curve to follow. Either lines of two columns, frequency and power, joined by
    /// straight pieces; or TOML: `[[piece]]` with `from` and `to`, each beginning where the last one
    /// ended, and `power = P` (level), `power = [P0, P1]` (straight) or
    /// `law = { power = P, at = N, exponent = E }`, which is P (nu/N)^E. Beyond the end the power is 1.
    /// --profile then names the new profile.
    #[arg(long, value_name = "FILE", requires = "profile")]
    target: Option<PathBuf>,
    /// Steps of the optimizer [default: the profile's].
    #[arg(long)]
    steps: Option<u32>,
    /// Threads to use; 0 for one per core. The table is the same with any number.
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// The file to write.
    #[arg(long, short, value_name = "FILE", conflicts_with = "out_dir")]
    output: Option<PathBuf>,
    /// A folder to write to, under the table's usual name [default: the current one].
    #[arg(long, value_name = "DIR")]
    out_dir: Option<PathBuf>,
    /// Replace a file that is there.
    #[arg(long)]
    force: bool,
    /// Write the table also if it misses a bound of its profile.
    #[arg(long)]
    keep_rejected: bool,
    /// Say nothing on standard error but errors.
    #[arg(long, short)]
    quiet: bool,
}

impl Args {
    fn job(&self) -> Result<Job, Failure> {
        let alpha: Alpha = self
            .alpha
            .parse()
            .map_err(|error| Failure::Usage(anyhow!("--alpha: {error}")))?;
        Ok(Job {
            alpha,
            radius: self.radius,
            profile: self.profile.clone(),
            seed: self.seed,
            target: self.target()?,
            steps: self.steps,
        })
    }

    fn target(&self) -> Result<Option<Target>, Failure> {
        let Some(file) = &self.target else {
            return Ok(None);
        };
        let text = std::fs::read_to_string(file)
            .with_context(|| format!("cannot read {}", file.display()))?;
        let target = text
            .parse()
            .with_context(|| format!("{} is not a power curve", file.display()));
        target.map(Some).map_err(Failure::Usage)
    }

    fn path(&self, job: &Job) -> PathBuf {
        let folder = || self.out_dir.clone().unwrap_or_default();
        let usual = || folder().join(file_name(&job.profile, job.alpha, job.radius));
        self.output.clone().unwrap_or_else(usual)
    }
}

/// Makes the table.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let job = args.job()?;
    let path = args.path(&job);
    if path.exists() && !args.force {
        let problem = anyhow!("{} is there already; --force replaces it", path.display());
        return Err(Failure::Usage(problem));
    }
    let usage = |error: ForgeError| Failure::Usage(error.into());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads)
        .build()
        .context("cannot start threads")?;
    let estimate = pool.install(|| job.estimate()).map_err(usage)?;
    if !args.quiet {
        eprintln!(
            "forging {}: {} blocks, {} steps over {} pairs, judged on {} points; about {:.0} s",
            path.display(),
            estimate.blocks,
            estimate.steps,
            estimate.pairs,
            estimate.measured_points,
            estimate.time.as_secs_f64().max(1.0)
        );
    }
    let impossible = estimate.correlation.filter(|least| least.is_impossible());
    if let Some(least) = impossible.filter(|_| !args.quiet) {
        eprintln!(
            "warning: no point set has exactly this power curve: its pair correlation would be \
             {:.2} at distance {:.2} (in mean spacings); what comes nearest is looked for",
            least.g, least.r
        );
    }
    let watcher = Watcher::new(args.quiet)?;
    let outcome = pool.install(|| forge(&job, &watcher)).map_err(usage)?;
    watcher.finish();
    conclude(args, &path, &outcome)
}

/// Writes what may be written and says how it went.
fn conclude(args: &Args, path: &std::path::Path, outcome: &Outcome) -> Result<(), Failure> {
    let complaints: Vec<String> = outcome.complaints.iter().map(ToString::to_string).collect();
    let nearness = outcome.nearness.as_ref().map(|near| {
        let met = if outcome.accepted { "met" } else { "missed" };
        format!("the target is {met}: {near}")
    });
    let judged = outcome.accepted || outcome.interrupted || args.keep_rejected;
    if !judged {
        let why: Vec<String> = nearness.into_iter().chain(complaints).collect();
        return Err(Failure::Other(anyhow!(
            "the table is rejected and not written (--keep-rejected would): {}",
            why.join("; ")
        )));
    }
    if let Some(nearness) = nearness.filter(|_| !args.quiet) {
        eprintln!("{nearness}");
    }
    write_table(path, &outcome.table).map_err(|error| Failure::Other(error.into()))?;
    println!("{}  {}", outcome.table.digest(), path.display());
    if outcome.interrupted {
        return Err(Failure::Other(anyhow!(
            "interrupted: {} holds the best so far, not judged",
            path.display()
        )));
    }
    for complaint in complaints {
        eprintln!("kept although rejected: {complaint}");
    }
    Ok(())
}

/// Shows how far the work is and passes on an interrupt.
struct Watcher {
    interrupted: Arc<AtomicBool>,
    quiet: bool,
    shown: Mutex<Option<(Stage, Progress)>>,
}

impl Watcher {
    fn new(quiet: bool) -> anyhow::Result<Self> {
        let interrupted = Arc::new(AtomicBool::new(false));
        let flag = interrupted.clone();
        ctrlc::set_handler(move || {
            // The first interrupt ends the work in good order, the second at once.
            if flag.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
        })
        .context("cannot listen for interrupts")?;
        Ok(Self {
            interrupted,
            quiet,
            shown: Mutex::new(None),
        })
    }

    fn finish(&self) {
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, progress)) = shown.take() {
            progress.finish();
        }
    }
}

impl Watch for Watcher {
    fn progress(&self, now: &strew_forge::Progress) {
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        if shown.as_ref().is_none_or(|(stage, _)| *stage != now.stage) {
            if let Some((_, last)) = shown.take() {
                last.finish();
            }
            let what = match now.stage {
                Stage::Optimizing => "steps",
                Stage::Measuring => "point sets measured",
            };
            *shown = Some((now.stage, Progress::new(what, now.steps.into(), self.quiet)));
        }
        if let Some((_, progress)) = shown.as_mut() {
            let note = now
                .energy
                .map_or(String::new(), |energy| format!("energy {energy:.9}"));
            progress.reach(now.step.into(), &note);
        }
    }

    fn stop(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }
}
