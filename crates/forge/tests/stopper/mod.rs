//! A watch that stops work and keeps its checkpoint.

use std::sync::Mutex;

use strew_forge::{Checkpoint, Progress, Stage, Watch};

/// Keeps the last checkpoint, and stops a stage after a number of steps.
pub struct Stopper {
    stage: Stage,
    after: u32,
    seen: Mutex<Option<Progress>>,
    pub kept: Mutex<Option<Checkpoint>>,
}

impl Stopper {
    pub fn new(stage: Stage, after: u32) -> Self {
        Self {
            stage,
            after,
            seen: Mutex::default(),
            kept: Mutex::default(),
        }
    }
}

impl Watch for Stopper {
    fn progress(&self, progress: &Progress) {
        *self.seen.lock().expect("no panic") = Some(*progress);
    }

    fn stop(&self) -> bool {
        let seen = self.seen.lock().expect("no panic");
        seen.is_some_and(|p| p.stage == self.stage && p.step >= self.after)
    }

    fn checkpoint(&self, checkpoint: &Checkpoint) {
        // Through a file's bytes, as after a crash.
        let back = Checkpoint::from_bytes(&checkpoint.to_bytes()).expect("valid");
        *self.kept.lock().expect("no panic") = Some(back);
    }
}
