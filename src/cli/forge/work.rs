//! The common parts of all work of the forge: threads, the written file, its checkpoint, and the watcher of progress and
//! interrupts.

use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use anyhow::{Context as _, anyhow};
use parking_lot::Mutex;
use strew_core::{
    Table,
    table::{Digest, Figures},
};
use strew_forge::{
    Checkpoint, Complaint, ForgeError, Stage, TableOf, Task, Watch, forge, gravest, resume, space,
    write_table,
};

use crate::cli::{Failure, config, output, progress::Progress, refuse, signals};

/// Flags of the threads and of the file.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct Work {
    /// Threads to use; 0 for one per core. The table is the same with any number.
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// The file to write.
    #[arg(long, short, value_name = "FILE", conflicts_with = "out_dir")]
    output: Option<PathBuf>,
    /// A folder to write to, under the table's usual name [default: the current one].
    #[arg(long, value_name = "DIR")]
    out_dir: Option<PathBuf>,
    /// Replace an existing file.
    #[arg(long)]
    force: bool,
    /// Write the table even if it misses a bound. If a new table is interrupted, write the best one so far, which is
    /// not judged.
    #[arg(long)]
    pub(super) keep_rejected: bool,
    /// Print nothing but errors on standard error.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

impl Work {
    /// The file to write, in the folder under its usual name. Fails if it exists or cannot be written.
    pub(super) fn path(&self, usual: &str) -> Result<PathBuf, Failure> {
        let in_folder = || self.out_dir.clone().unwrap_or_default().join(usual);
        let path = self.output.clone().unwrap_or_else(in_folder);
        output::must_be_new(&path, self.force)?;
        output::check(&path)?;
        Ok(path)
    }

    pub(super) fn pool(&self) -> anyhow::Result<rayon::ThreadPool> {
        config::pool(self.threads)
    }

    pub(super) fn threads(&self) -> usize {
        match self.threads {
            0 => std::thread::available_parallelism().map_or(1, usize::from),
            threads => threads,
        }
    }

    /// Writes a table and reports it; `what` names the part that was made. Fails if that was rejected and is not to be
    /// kept, with `why` and the missed bounds.
    pub(super) fn conclude(
        &self,
        path: &Path,
        what: &str,
        table: &impl Made,
        (is_accepted, complaints): (bool, &[Complaint]),
        why: Option<String>,
    ) -> Result<(), Failure> {
        let complaints = gravest(complaints);
        if !is_accepted && !self.keep_rejected {
            let why: Vec<String> = why.into_iter().chain(complaints).collect();
            return Err(Failure::Other(anyhow!(
                "the {what} is rejected and not written (the same command with --keep-rejected writes it): {}",
                why.join("; ")
            )));
        }
        write(path, table)?;
        if let Some(why) = why.filter(|_| !self.quiet) {
            eprintln!("{why}");
        }
        for complaint in complaints {
            eprintln!("kept although rejected: {complaint}");
        }
        Ok(())
    }

    /// The message of interrupted work, which says where it resumes. Writes the best table so far if it is to be kept.
    fn interrupted(
        &self,
        path: &Path,
        table: &impl Made,
        watcher: &Watcher,
    ) -> Result<String, Failure> {
        let mut text = String::from("interrupted");
        if self.keep_rejected {
            write(path, table)?;
            text += &format!("; {} holds the best so far, not judged", path.display());
        }
        if watcher.has_kept() {
            let force = match self.keep_rejected {
                true => " with --force",
                false => "",
            };
            let kept = Checkpoints::path(path);
            text += &format!("; the same command{force} resumes from {}", kept.display());
        }
        Ok(text)
    }

    pub(super) fn show(&self, figures: &[Figures]) {
        for figures in figures.iter().filter(|_| !self.quiet) {
            let values = figures.values.iter();
            let values = values.map(|(name, value)| format!("{name} {value:.3e}"));
            let values = values.collect::<Vec<_>>().join(", ");
            eprintln!("{}: {values}", figures.subject);
        }
    }
}

pub(super) trait Made {
    /// Writes its file. Returns its digest.
    fn write(&self, path: &Path) -> Result<Digest, ForgeError>;
}

impl Made for Table {
    fn write(&self, path: &Path) -> Result<Digest, ForgeError> {
        write_table(path, self).map(|()| self.digest())
    }
}

impl Made for strew_core::space::Table {
    fn write(&self, path: &Path) -> Result<Digest, ForgeError> {
        space::write_table(path, self).map(|()| self.digest())
    }
}

/// Writes a table, and prints its digest and its path.
fn write(path: &Path, table: &impl Made) -> Result<(), Failure> {
    let digest = table.write(path).map_err(Failure::other)?;
    output::print(&format!("{digest}  {}\n", path.display()))
}

/// Flags of work that takes long.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct Checkpoints {
    /// Ignore an existing checkpoint and begin anew.
    #[arg(long)]
    restart: bool,
    /// Seconds between checkpoints; 0 writes one after every step.
    #[arg(long, value_name = "SECONDS", default_value_t = 10)]
    checkpoint_every: u64,
}

impl Checkpoints {
    /// Makes the table of a job, anew or from its checkpoint, and writes it. Before that, `announce` shows what takes
    /// `steps`.
    pub(super) fn made<J: Task>(
        &self,
        work: &Work,
        path: &Path,
        job: &J,
        (steps, announce): (u32, impl FnOnce()),
    ) -> Result<TableOf<J>, Failure>
    where
        TableOf<J>: Made,
    {
        let kept = Self::path(path);
        let found = self.found(&kept, work.quiet, job)?;
        if !work.quiet {
            announce();
            if let Some(found) = &found {
                let (step, from) = (found.steps(), kept.display());
                eprintln!("resuming at step {step} of {steps}, from {from}");
            }
        }
        let every = Duration::from_secs(self.checkpoint_every);
        let watcher = Watcher::new(&kept, every, work.quiet);
        let outcome = match found {
            None => forge(job, &watcher),
            Some(found) => resume(job, found, &watcher),
        };
        let outcome = outcome.map_err(Failure::usage)?;
        watcher.finish();
        if outcome.interrupted {
            let text = work.interrupted(path, &outcome.table, &watcher)?;
            return Err(Failure::Interrupted(anyhow!(text)));
        }
        let nearness = outcome.nearness.map(|near| {
            let met = if outcome.accepted { "met" } else { "missed" };
            format!("the target is {met}: {near}")
        });
        let judged = (outcome.accepted, &outcome.complaints[..]);
        work.conclude(path, "table", &outcome.table, judged, nearness)?;
        match fs::remove_file(&kept) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                let unremovable = || format!("cannot remove {}", kept.display());
                Err(error).with_context(unremovable)?
            }
            _ => Ok(outcome.table),
        }
    }

    fn path(table: &Path) -> PathBuf {
        let mut name = table.as_os_str().to_owned();
        name.push(".checkpoint");
        name.into()
    }

    /// The checkpoint to resume from, if there is one of the job.
    fn found(
        &self,
        path: &Path,
        quiet: bool,
        job: &impl Task,
    ) -> Result<Option<Checkpoint>, Failure> {
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
                // It is that of a rejected table, and spares only the steps of that job.
                if !quiet {
                    eprintln!("beginning anew: {}: {error}", path.display());
                }
                Ok(None)
            }
            Err(error) => refuse!("{}: {error}; finish that job, or {advice}", path.display()),
        }
    }
}

/// Shows progress on standard error and keeps the latest checkpoint in a file.
pub(super) struct Watcher {
    interrupted: Arc<AtomicBool>,
    quiet: bool,
    path: PathBuf,
    every: Duration,
    shown: Mutex<Option<(Stage, Progress)>>,
    kept: Mutex<Kept>,
}

struct Kept {
    /// When it was written, or the work began.
    at: Instant,
    /// Whether it holds the latest checkpoint.
    good: bool,
    warned: bool,
}

impl Watcher {
    /// Checkpoints go to `path`, at least `every` apart.
    pub(super) fn new(path: &Path, every: Duration, quiet: bool) -> Self {
        Self {
            // The first signal ends the work in good order, the second at once.
            interrupted: signals::stop_flag(),
            quiet,
            path: path.to_owned(),
            every,
            shown: Mutex::new(None),
            kept: Mutex::new(Kept {
                at: Instant::now(),
                good: false,
                warned: false,
            }),
        }
    }

    pub(super) fn finish(&self) {
        let mut shown = self.shown.lock();
        if let Some((_, progress)) = shown.take() {
            progress.finish();
        }
    }

    fn has_kept(&self) -> bool {
        let kept = self.kept.lock();
        kept.good
    }
}

impl Watch for Watcher {
    fn progress(&self, now: &strew_forge::Progress) {
        let mut shown = self.shown.lock();
        if shown.as_ref().is_none_or(|(stage, _)| *stage != now.stage) {
            if let Some((_, last)) = shown.take() {
                last.finish();
            }
            let what = match now.stage {
                Stage::Optimizing => "steps",
                Stage::Measuring => "point sets measured",
            };
            let progress = Progress::new(what, now.steps.into(), self.quiet);
            *shown = Some((now.stage, progress.going_on_at(now.step.into())));
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

    fn wants_checkpoint(&self) -> bool {
        let kept = self.kept.lock();
        kept.at.elapsed() >= self.every
    }

    fn checkpoint(&self, checkpoint: &Checkpoint) {
        let written = checkpoint.write(&self.path);
        let mut kept = self.kept.lock();
        kept.good = written.is_ok();
        kept.at = Instant::now();
        if let (Err(error), false) = (written, kept.warned) {
            kept.warned = true;
            eprintln!("warning: no checkpoint is kept: {error}");
        }
    }
}
