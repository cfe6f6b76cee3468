//! `strew forge`: makes a table, judges it, writes it; a ladder or kinds for a table.

mod ladder;
mod mix;

use std::{
    fs,
    io::Read as _,
    path::{Path, PathBuf},
    time::Duration,
};

use anyhow::{Context as _, anyhow};
use strew_core::Alpha;
use strew_forge::{
    Checkpoint, DEFAULT_SEED, Estimate, ForgeError, Job, Outcome, Prospect, Target, file_name,
    forge, gravest, resume, write_table,
};

use super::{Failure, output, watcher::Watcher};
use crate::service::query::{DEFAULT_ALPHA, DEFAULT_PROFILE};

/// Checkpoints lie beside the table, with this behind its name.
const CHECKPOINT: &str = ".checkpoint";
/// No file of a curve is larger.
const MAX_TARGET_BYTES: u64 = 1 << 20;

/// Flags of `strew forge`. Equal jobs make equal tables, bit by bit, on every machine.
///
/// Now and then, and on an interrupt, the forge keeps a checkpoint beside the table, under its name
/// with `.checkpoint` behind it. The same command goes on from there, to the same table as without
/// the interruption; it is removed when the table is written.
#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true)]
pub(super) struct Args {
    #[command(subcommand)]
    task: Option<Task>,
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
    /// Make a ladder for this table instead of a new table: displacements for thinned sets. Its vectors
    /// stay as they are.
    #[arg(long, value_name = "TABLE", conflicts_with_all = ["profile", "alpha", "radius", "seed", "target"])]
    ladder_of: Option<PathBuf>,
    /// Levels of the ladder each time the share of points halves.
    #[arg(long, default_value_t = 16, requires = "ladder_of")]
    per_octave: u32,
    /// How often the share halves along the ladder.
    #[arg(long, default_value_t = 6, requires = "ladder_of")]
    octaves: u32,
    /// Steps of the optimizer [default: the profile's, or 100 for a ladder].
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
    /// Write the table also if it misses a bound of its profile, or if the work is interrupted before
    /// it is judged.
    #[arg(long)]
    keep_rejected: bool,
    /// Begin anew, whatever checkpoint there is.
    #[arg(long)]
    restart: bool,
    /// Keep a checkpoint so often, in seconds; 0 after every step.
    #[arg(long, value_name = "SECONDS", default_value_t = 10)]
    checkpoint_every: u64,
    /// Say nothing on standard error but errors.
    #[arg(long, short)]
    quiet: bool,
}

/// Other work of the forge.
#[derive(Debug, clap::Subcommand)]
enum Task {
    /// Make kinds for a table: each of its points is of one kind, and each kind is evenly spread.
    Mix(mix::Args),
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
        let mut text = String::new();
        fs::File::open(file)
            .and_then(|open| open.take(MAX_TARGET_BYTES + 1).read_to_string(&mut text))
            .with_context(|| format!("cannot read {}", file.display()))?;
        if text.len() as u64 > MAX_TARGET_BYTES {
            let problem = anyhow!(
                "{} is larger than any power curve: at most {MAX_TARGET_BYTES} bytes are read",
                file.display()
            );
            return Err(Failure::Usage(problem));
        }
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

/// The checkpoint's place beside a table.
fn checkpoint_path(table: &Path) -> PathBuf {
    let mut name = table.as_os_str().to_owned();
    name.push(CHECKPOINT);
    name.into()
}

/// Makes the table, a ladder or kinds.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(Task::Mix(args)) = &args.task {
        return mix::run(args);
    }
    if let Some(table) = &args.ladder_of {
        return ladder::run(args, table);
    }
    let job = args.job()?;
    let path = args.path(&job);
    if path.exists() && !args.force {
        let problem = anyhow!("{} is there already; --force replaces it", path.display());
        return Err(Failure::Usage(problem));
    }
    output::check(&path)?;
    let usage = |error: ForgeError| Failure::Usage(error.into());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads)
        .build()
        .context("cannot start threads")?;
    let estimate = pool.install(|| job.estimate()).map_err(usage)?;
    let kept = checkpoint_path(&path);
    let found = pool.install(|| args.checkpoint(&job, &kept))?;
    if !args.quiet {
        announce(&path, &job.prospect(), &estimate);
        if let Some(found) = &found {
            let (steps, from) = (found.steps(), kept.display());
            eprintln!(
                "going on at step {steps} of {}, from {from}",
                estimate.steps
            );
        }
    }
    let every = Duration::from_secs(args.checkpoint_every);
    let watcher = Watcher::new(&kept, every, args.quiet);
    let outcome = pool.install(|| match found {
        None => forge(&job, &watcher),
        Some(found) => resume(&job, found, &watcher),
    });
    let outcome = outcome.map_err(usage)?;
    watcher.finish();
    if outcome.interrupted {
        return interrupted(args, &path, &outcome, &watcher);
    }
    conclude(args, &path, &outcome)?;
    // The table is there; what is left of the work serves nobody.
    match fs::remove_file(&kept) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            let problem = anyhow!(error).context(format!("cannot remove {}", kept.display()));
            Err(Failure::Other(problem))
        }
        _ => Ok(()),
    }
}

impl Args {
    /// The checkpoint to go on from, if there is one of this job.
    fn checkpoint(&self, job: &Job, path: &Path) -> Result<Option<Checkpoint>, Failure> {
        if self.restart {
            return Ok(None);
        }
        let advice = "--restart begins anew and replaces it";
        let found = Checkpoint::read_file(path)
            .map_err(|error| Failure::Usage(anyhow!("{error}; {advice}")))?;
        let Some(found) = found else {
            return Ok(None);
        };
        match found.is_of(job) {
            Ok(()) => Ok(Some(found)),
            Err(error) if found.is_optimized() => {
                // A rejected table's: it spares no more than that job's steps.
                if !self.quiet {
                    eprintln!("beginning anew: {}: {error}", path.display());
                }
                Ok(None)
            }
            Err(error) => Err(Failure::Usage(anyhow!(
                "{}: {error}; finish that job, or {advice}",
                path.display()
            ))),
        }
    }
}

/// Says what will be done, and whether it can succeed.
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
             {:.2} at distance {:.2} (in mean spacings); what comes nearest is looked for",
            least.g, least.r
        );
    }
}

/// Says where interrupted work can go on.
fn interrupted(
    args: &Args,
    path: &Path,
    outcome: &Outcome,
    watcher: &Watcher,
) -> Result<(), Failure> {
    let mut said = String::from("interrupted");
    if args.keep_rejected {
        write_table(path, &outcome.table).map_err(|error| Failure::Other(error.into()))?;
        report(path, outcome)?;
        said += &format!("; {} holds the best so far, not judged", path.display());
    }
    if watcher.has_kept() {
        let force = if args.keep_rejected {
            " with --force"
        } else {
            ""
        };
        let kept = checkpoint_path(path);
        said += &format!("; the same command{force} goes on from {}", kept.display());
    }
    Err(Failure::Interrupted(anyhow!(said)))
}

/// Writes what may be written and says how it went.
fn conclude(args: &Args, path: &Path, outcome: &Outcome) -> Result<(), Failure> {
    let complaints = gravest(&outcome.complaints);
    let nearness = outcome.nearness.as_ref().map(|near| {
        let met = if outcome.accepted { "met" } else { "missed" };
        format!("the target is {met}: {near}")
    });
    if !outcome.accepted && !args.keep_rejected {
        let why: Vec<String> = nearness.into_iter().chain(complaints).collect();
        return Err(Failure::Other(anyhow!(
            "the table is rejected and not written (the same command with --keep-rejected writes \
             it): {}",
            why.join("; ")
        )));
    }
    write_table(path, &outcome.table).map_err(|error| Failure::Other(error.into()))?;
    report(path, outcome)?;
    if let Some(nearness) = nearness.filter(|_| !args.quiet) {
        eprintln!("{nearness}");
    }
    for complaint in complaints {
        eprintln!("kept although rejected: {complaint}");
    }
    Ok(())
}

/// Prints the digest and the path of the table that was written.
fn report(path: &Path, outcome: &Outcome) -> Result<(), Failure> {
    output::print(&format!("{}  {}\n", outcome.table.digest(), path.display()))
}
