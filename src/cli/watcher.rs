//! Watches a job of the forge: shows its progress, passes on interrupts, writes checkpoints.

use std::{
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use strew_forge::{Checkpoint, Stage, Watch};

use super::{progress::Progress, signals};

/// Shows progress on standard error and keeps the latest checkpoint in a file.
pub(super) struct Watcher {
    interrupted: Arc<AtomicBool>,
    quiet: bool,
    path: PathBuf,
    every: Duration,
    shown: Mutex<Option<(Stage, Progress)>>,
    kept: Mutex<Kept>,
}

/// The state of the checkpoint's file.
struct Kept {
    /// When it was written, or the work began.
    at: Instant,
    /// Whether it holds the latest checkpoint.
    good: bool,
    /// Whether the user was warned that it cannot be written.
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

    /// Removes the bar at the end of the work.
    pub(super) fn finish(&self) {
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, progress)) = shown.take() {
            progress.finish();
        }
    }

    /// Whether the file holds the latest checkpoint.
    pub(super) fn has_kept(&self) -> bool {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.good
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
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.at.elapsed() >= self.every
    }

    fn checkpoint(&self, checkpoint: &Checkpoint) {
        let written = checkpoint.write(&self.path);
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.good = written.is_ok();
        kept.at = Instant::now();
        if let (Err(error), false) = (written, kept.warned) {
            kept.warned = true;
            eprintln!("warning: no checkpoint is kept: {error}");
        }
    }
}
