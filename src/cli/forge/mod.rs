//! `strew forge`: makes a table of the plane or of points in space, judges it, writes it; `strew forge mix`: makes kinds
//! for a table.

mod work;

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use anyhow::{Context as _, anyhow};
use strew_catalog::{Catalog, Dimension, Key};
use strew_config::bounded_file;
use strew_core::{Alpha, Table, map::Size, table::Shares};
use strew_forge::{
    DEFAULT_SEED, Estimate, Job, MixJob, Prospect, Target, estimate, file_name, mix, mix_file_name,
    read_table,
    space::{SpaceJob, SpaceProfile, table_file_name},
};
use strew_query::{DEFAULT_ALPHA, DEFAULT_PROFILE};

use self::work::{Checkpoints, Watcher, Work};
use super::{Failure, refuse};

/// Flags of `strew forge`. Equal jobs make equal tables, bit by bit, on every machine.
///
/// At intervals and on an interrupt, the forge writes a checkpoint beside the table, under its name
/// with `.checkpoint` added. The same command resumes from it, to the same table as without the
/// interruption, and removes it when the table is written.
#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true)]
pub(super) struct Args {
    #[command(subcommand)]
    task: Option<Task>,
    #[command(flatten)]
    table: TableArgs,
    /// Steps of the optimizer [default: the profile's].
    #[arg(long)]
    steps: Option<u32>,
    #[command(flatten)]
    work: Work,
    #[command(flatten)]
    checkpoints: Checkpoints,
}

/// Other work of the forge.
#[derive(Debug, clap::Subcommand)]
enum Task {
    /// Make kinds for a table: each of its points is of one kind, and each kind is evenly spread.
    Mix(MixArgs),
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let Args { work, steps, .. } = args;
    match &args.task {
        Some(Task::Mix(args)) => make_mix(args),
        None => work.pool()?.install(|| match args.table.space {
            true => in_space(&args.table.job_in_space(*steps)?, work, &args.checkpoints),
            false => in_plane(&args.table.job(*steps)?, work, &args.checkpoints),
        }),
    }
}

const MAX_TARGET_BYTES: u64 = 1 << 20;

/// The half-width R of the map of a table of the plane.
const DEFAULT_RADIUS: u32 = 49;

/// Flags of a new table.
#[derive(Debug, clap::Args)]
#[group(skip)]
struct TableArgs {
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

    /// The job of a table of points in space. What the flags leave open is as in the shipped tables.
    fn job_in_space(&self, steps: Option<u32>) -> Result<SpaceJob, Failure> {
        let profile = &self.profile;
        let Some(profile) = SpaceProfile::named(profile) else {
            let names = SpaceProfile::ALL.map(SpaceProfile::name).join(", ");
            refuse!(
                "--profile {profile}: no profile of points in space; allowed with --space: {names}"
            );
        };
        let default = SpaceJob::new(profile);
        Ok(SpaceJob {
            alpha: self.alpha,
            radius: self.radius.unwrap_or(default.radius),
            seed: self.seed.unwrap_or(default.seed),
            steps,
            ..default
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

fn in_plane(job: &Job, work: &Work, checkpoints: &Checkpoints) -> Result<(), Failure> {
    let path = work.path(&file_name(&job.profile, job.alpha, job.radius))?;
    let estimate = estimate(job).map_err(Failure::usage)?;
    let announced = || announce(&path, &job.prospect(), &estimate);
    checkpoints.made(work, &path, job, (estimate.steps, announced))?;
    Ok(())
}

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

fn in_space(job: &SpaceJob, work: &Work, checkpoints: &Checkpoints) -> Result<(), Failure> {
    let usual = table_file_name(job.profile.name(), job.alpha, job.radius);
    let path = work.path(&usual)?;
    let estimate = estimate(job).map_err(Failure::usage)?;
    let announced = || announce_in_space(&path, &estimate, work.threads());
    let table = checkpoints.made(work, &path, job, (estimate.steps, announced))?;
    work.show(&table.provenance().figures);
    Ok(())
}

fn announce_in_space(path: &Path, estimate: &Estimate, threads: usize) {
    eprintln!(
        "forging {}: {} blocks, {} steps, judged on {} points; about {:.0} s on {threads} threads",
        path.display(),
        estimate.blocks,
        estimate.steps,
        estimate.measured_points,
        estimate.time.as_secs_f64().max(1.0),
    );
}

/// Flags of `strew forge mix`. Equal flags make equal tables, bit by bit, on every machine.
#[derive(Debug, clap::Args)]
struct MixArgs {
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

impl MixArgs {
    fn job(&self) -> MixJob {
        let shares = self.shares.clone();
        let mut job = match self.joint {
            true => MixJob::joint(shares),
            false => MixJob::labels(shares),
        };
        job.steps = self.steps.unwrap_or(job.steps);
        job
    }

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

fn make_mix(args: &MixArgs) -> Result<(), Failure> {
    let (table, job, work) = (args.of()?, args.job(), &args.work);
    let path = work.path(&mix_file_name(&table, &job))?;
    // It takes seconds, so there are no checkpoints.
    let watcher = Watcher::new(&path, Duration::MAX, work.quiet);
    let outcome = work.pool()?.install(|| mix(&table, &job, &watcher));
    watcher.finish();
    let Some(outcome) = outcome.map_err(Failure::usage)? else {
        return Err(Failure::Interrupted(anyhow!("interrupted")));
    };
    let judged = (outcome.accepted, &outcome.complaints[..]);
    work.conclude(&path, "mix", &outcome.table, judged, None)?;
    work.show(&outcome.figures);
    Ok(())
}
