//! Making the table of a job, on threads of its own with the lowest priority.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    path::PathBuf,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use strew_config as config;
use strew_forge::{Checkpoint, Outcome, Progress, Watch, forge, gravest, resume};

use super::{Inner, State, folder::Folder, job::Shared};

/// The lowest priority there is.
const NICENESS: i32 = 19;

/// The outcome of a job.
enum End {
    Finished(String),
    Rejected(Vec<String>),
    Failed(String),
    /// It was cancelled, or the daemon stops.
    Interrupted,
}

impl Inner {
    /// Starts jobs that wait while there are places.
    pub(super) fn start_next(inner: &Arc<Self>) {
        loop {
            let mut jobs = inner.jobs();
            let is_full = jobs.running >= inner.settings.max_running;
            if is_full || inner.is_stopping.load(Ordering::Acquire) {
                return;
            }
            let Some(job) = jobs.next() else {
                return;
            };
            jobs.running += 1;
            drop(jobs);
            job.change(|status| status.state = State::Running);
            let (own, started) = (inner.clone(), job.clone());
            let thread = std::thread::Builder::new().name("strew-forge".into());
            let spawned = thread.spawn(move || {
                own.work(&started);
                Self::start_next(&own);
            });
            if let Err(error) = spawned {
                inner.settle(&job, End::Failed(error.to_string()));
            }
        }
    }

    fn work(&self, job: &Shared) {
        let Some(folder) = &self.folder else { return };
        // A bug in the optimizer must not cost a place for good.
        let made = catch_unwind(AssertUnwindSafe(|| self.make(folder, job)));
        let end = made.unwrap_or_else(|_| Ok(End::Failed("the forge panicked".into())));
        self.settle(job, end.unwrap_or_else(End::Failed));
    }

    /// Notes how a job has ended. The place is free again.
    fn settle(&self, job: &Shared, end: End) {
        let mut jobs = self.jobs();
        jobs.running -= 1;
        match end {
            End::Finished(digest) => self.end(&mut jobs, job, State::Finished, |status| {
                status.digest = Some(digest);
            }),
            End::Rejected(complaints) => self.end(&mut jobs, job, State::Rejected, |status| {
                status.complaints = complaints;
            }),
            End::Failed(detail) => {
                tracing::error!(id = job.id(), detail, "a table could not be made");
                self.end(&mut jobs, job, State::Failed, |status| {
                    status.detail = Some(detail);
                });
            }
            End::Interrupted if job.is_cancelled() => {
                self.end(&mut jobs, job, State::Cancelled, |_| {});
            }
            // The daemon stops; the document on disk still has the job as unfinished.
            End::Interrupted => {}
        }
        drop(jobs);
        self.ended.notify_all();
    }

    fn make(&self, folder: &Folder, job: &Shared) -> Result<End, String> {
        let config::Forge {
            threads,
            checkpoint_seconds,
            ..
        } = self.settings;
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("strew-forge-{i}"))
            .start_handler(|_| give_way())
            .build()
            .map_err(|error| error.to_string())?;
        let path = folder.checkpoint(job.id());
        let watch = Watcher {
            job,
            is_stopping: &self.is_stopping,
            every: config::seconds(checkpoint_seconds),
            kept: Mutex::new(Instant::now()),
            path,
        };
        let outcome = pool.install(|| watch.run());
        let outcome = outcome.map_err(|error| error.to_string())?;
        if outcome.interrupted {
            return Ok(End::Interrupted);
        }
        if !outcome.accepted {
            return Ok(End::Rejected(gravest(&outcome.complaints)));
        }
        let path = folder.store(job.made(), job.id(), &outcome.table)?;
        (self.publish)(path)?;
        Ok(End::Finished(outcome.table.digest().to_string()))
    }
}

/// Follows the work of a job.
struct Watcher<'a> {
    job: &'a Shared,
    is_stopping: &'a AtomicBool,
    every: Duration,
    /// When the last checkpoint was kept.
    kept: Mutex<Instant>,
    path: PathBuf,
}

impl Watcher<'_> {
    /// Goes on from the checkpoint, if there is one of this job, or begins.
    fn run(&self) -> Result<Outcome, strew_forge::ForgeError> {
        let job = self.job.made();
        let found = Checkpoint::read_file(&self.path).unwrap_or_else(|error| {
            tracing::warn!(%error, "a checkpoint cannot be read: the job begins anew");
            None
        });
        match found.filter(|found| found.is_of(job).is_ok()) {
            Some(found) => {
                let step = found.steps();
                tracing::info!(
                    id = self.job.id(),
                    step,
                    "forging resumes from a checkpoint"
                );
                resume(job, found, self)
            }
            None => forge(job, self),
        }
    }
}

impl Watch for Watcher<'_> {
    fn progress(&self, progress: &Progress) {
        self.job.progress(progress);
    }

    fn stop(&self) -> bool {
        self.job.is_cancelled() || self.is_stopping.load(Ordering::Acquire)
    }

    fn wants_checkpoint(&self) -> bool {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.elapsed() >= self.every
    }

    fn checkpoint(&self, checkpoint: &Checkpoint) {
        if let Err(error) = checkpoint.write(&self.path) {
            tracing::warn!(%error, id = self.job.id(), "no checkpoint is kept");
        }
        *self.kept.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
    }
}

/// Lowers the priority of the calling thread. (On Linux a thread has a priority of its own.)
fn give_way() {
    #[cfg(any(target_os = "android", target_os = "linux"))]
    let _ = rustix::process::setpriority_process(None, NICENESS);
    #[cfg(not(any(target_os = "android", target_os = "linux")))]
    let _ = NICENESS;
}
