//! The phases of a job, in the plane and in space: steps that change a state, which checkpoints keep. A caller follows the work
//! and stops it.
//!
//! The caller implements [`Watch`]. The optimizer and the judge count their steps with a [`Meter`],
//! which reports [`Progress`] to it. None of them reads a clock, which WebAssembly lacks.

use crate::{Checkpoint, ForgeError, State};

/// A stage of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The optimizer lowers the energy, step by step.
    Optimizing,
    /// The judge measures the table, one point set a step.
    Measuring,
}

/// The progress of the work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    pub stage: Stage,
    /// The number of steps done in this stage.
    pub step: u32,
    /// The number of steps in this stage.
    pub steps: u32,
    /// The energy per point; `None` while measuring and before the first step. It falls within a
    /// phase of the optimization and jumps from one phase to the next, because their energies
    /// differ.
    pub energy: Option<f64>,
}

/// Follows the work and may stop it. Nothing else it does affects the result. Work that was stopped
/// and [resumed](crate::resume) has the same result as work that was not.
pub trait Watch: Sync {
    /// Called before the first step and after every step of a stage. Must be quick.
    fn progress(&self, progress: &Progress);

    /// Called before every step. Once it returns true, the work ends with the best result so far.
    fn stop(&self) -> bool {
        false
    }

    /// Called between steps of the optimizer: whether to make a checkpoint now, which copies the
    /// whole state.
    fn wants_checkpoint(&self) -> bool {
        false
    }

    /// Called with a checkpoint when one was wanted, when the optimizer is stopped, and when it is
    /// done and only measuring is left.
    fn checkpoint(&self, checkpoint: &Checkpoint) {
        let _ = checkpoint;
    }
}

/// Ignores progress and never stops.
impl Watch for () {
    fn progress(&self, _: &Progress) {}
}

/// Counts the steps of a stage and reports them to a watch.
pub struct Meter<'a> {
    watch: &'a dyn Watch,
    stage: Stage,
    step: u32,
    steps: u32,
}

impl<'a> Meter<'a> {
    /// Begins a stage of `steps` steps.
    pub fn new(watch: &'a dyn Watch, stage: Stage, steps: u32) -> Self {
        Self::from(watch, stage, steps, 0)
    }

    /// Resumes a stage of `steps` steps, of which `first` are done.
    pub fn from(watch: &'a dyn Watch, stage: Stage, steps: u32, first: u32) -> Self {
        let meter = Self {
            watch,
            stage,
            step: first,
            steps,
        };
        meter.report(None);
        meter
    }

    /// Whether the watch stops the work.
    pub fn stop(&self) -> bool {
        self.watch.stop()
    }

    /// Whether the watch wants a checkpoint.
    pub fn wants_checkpoint(&self) -> bool {
        self.watch.wants_checkpoint()
    }

    /// Counts a step and reports it, with the energy that it evaluated, if any.
    pub fn advance(&mut self, energy: Option<f64>) {
        self.step += 1;
        self.report(energy);
    }

    fn report(&self, energy: Option<f64>) {
        self.watch.progress(&Progress {
            stage: self.stage,
            step: self.step,
            steps: self.steps,
            energy,
        });
    }
}

/// A phase of a job.
pub trait Phase {
    /// The number of steps.
    fn steps(&self) -> u32;

    /// The steps in words, among all that decides the result of a job.
    fn describe(&self) -> String;

    /// Prepares to go on from a state: the first one of the phase, or that of a checkpoint.
    fn begin(&mut self, state: &mut State);

    /// Takes a step. Returns the energy before it, per point, or another value that progress shows.
    fn step(&mut self, state: &mut State) -> f64;

    /// Completes a state for a checkpoint.
    fn complete(&self, state: &mut State) {
        let _ = state;
    }

    /// The first state of the next phase.
    fn end(&self, state: State) -> Result<State, ForgeError>;

    /// The largest number of pairs that a step has visited; 0 if its energy is no pair energy.
    fn pairs(&self) -> usize {
        0
    }
}

/// Takes the steps of a phase that are left, or fewer if the watch stops the work. Calls `keep` with the state between two
/// steps when the watch wants a checkpoint and when it stops the work. Returns whether all steps are done.
pub(crate) fn work_off(
    phase: &mut (impl Phase + ?Sized),
    state: &mut State,
    meter: &mut Meter<'_>,
    keep: &mut dyn FnMut(&State),
) -> bool {
    phase.begin(state);
    while state.steps < phase.steps() {
        let stop = meter.stop();
        if stop || meter.wants_checkpoint() {
            phase.complete(state);
            keep(state);
        }
        if stop {
            return false;
        }
        let value = phase.step(state);
        meter.advance(Some(value));
    }
    true
}
