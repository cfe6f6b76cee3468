//! How a caller follows and stops the work.

use std::time::{Duration, Instant};

use crate::Checkpoint;

/// What is being done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The energy is being lowered, step by step.
    Optimizing,
    /// The table is being judged, subject by subject.
    Measuring,
}

/// How far the work has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// Steps of this stage that are done.
    pub step: u32,
    /// Steps that this stage will take.
    pub steps: u32,
    /// While optimizing, the energy per point. It falls within a phase and jumps between phases,
    /// whose energies differ.
    pub energy: Option<f64>,
    /// Time since the stage began, or went on.
    pub elapsed: Duration,
    /// Time the stage will still take, if it goes on as it went.
    pub left: Duration,
}

/// Follows the work. Nothing it does changes the result, except stopping; and work that was stopped
/// and [goes on](crate::Checkpoint) has the same result, too.
pub trait Watch: Sync {
    /// Told before the first step and after every step; must be quick.
    fn progress(&self, progress: &Progress);

    /// Asked before every step; once it answers yes, the work ends with the best so far.
    fn stop(&self) -> bool {
        false
    }

    /// Asked between steps: whether a checkpoint is wanted now. Each is a copy of all state.
    fn wants_checkpoint(&self) -> bool {
        false
    }

    /// Handed a checkpoint: when one was wanted, when the work is stopped, and when only measuring
    /// is left.
    fn checkpoint(&self, checkpoint: &Checkpoint) {
        let _ = checkpoint;
    }
}

/// Nobody watches.
impl Watch for () {
    fn progress(&self, _: &Progress) {}
}

/// Counts the steps of a stage for a watch.
pub struct Meter<'a> {
    watch: &'a dyn Watch,
    stage: Stage,
    /// Steps that were done before.
    first: u32,
    step: u32,
    steps: u32,
    began: Instant,
}

impl<'a> Meter<'a> {
    /// A stage of `steps` steps begins.
    #[must_use]
    pub fn new(watch: &'a dyn Watch, stage: Stage, steps: u32) -> Self {
        Self::from(watch, stage, steps, 0)
    }

    /// A stage of `steps` steps goes on, `first` of which are done.
    #[must_use]
    pub fn from(watch: &'a dyn Watch, stage: Stage, steps: u32, first: u32) -> Self {
        let meter = Self {
            watch,
            stage,
            first,
            step: first,
            steps,
            began: Instant::now(),
        };
        meter.tell(None);
        meter
    }

    /// Whether the watch wants the work to end.
    #[must_use]
    pub fn stop(&self) -> bool {
        self.watch.stop()
    }

    /// Whether the watch wants a checkpoint.
    #[must_use]
    pub fn wants_checkpoint(&self) -> bool {
        self.watch.wants_checkpoint()
    }

    /// A step is done.
    pub fn advance(&mut self, energy: Option<f64>) {
        self.step += 1;
        self.tell(energy);
    }

    fn tell(&self, energy: Option<f64>) {
        let elapsed = self.began.elapsed();
        self.watch.progress(&Progress {
            stage: self.stage,
            step: self.step,
            steps: self.steps,
            energy,
            elapsed,
            left: elapsed * self.steps.saturating_sub(self.step)
                / self.step.saturating_sub(self.first).max(1),
        });
    }
}
