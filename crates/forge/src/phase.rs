//! The phases of a job, in the plane and in space: steps that change a state, which checkpoints keep.

use crate::{ForgeError, checkpoint::Kept, watch::Meter};

/// All that decides the next step of a phase.
pub trait State: Sized {
    /// The steps done in the phase.
    fn steps(&self) -> u32;

    /// The number of vectors.
    fn blocks(&self) -> usize;

    /// The state for a checkpoint.
    fn keep(&self) -> Kept;

    /// The state of a checkpoint, or `None` if it is another one.
    fn resume(kept: Kept) -> Option<Self>;
}

/// A phase of a job.
pub trait Phase<S> {
    /// The number of steps.
    fn steps(&self) -> u32;

    /// The steps in words, among all that decides the result of a job.
    fn describe(&self) -> String;

    /// Prepares to go on from a state: the first one of the phase, or that of a checkpoint.
    fn begin(&mut self, state: &S);

    /// Takes a step. Returns the energy before it, per point, or another value that progress shows.
    fn step(&mut self, state: &mut S) -> f64;

    /// Completes a state for a checkpoint.
    fn complete(&self, state: &mut S) {
        let _ = state;
    }

    /// The first state of the next phase.
    ///
    /// # Errors
    /// [`ForgeError`] for a part of the job that is not allowed.
    fn end(&self, state: S) -> Result<S, ForgeError>;

    /// The largest number of pairs that a step has visited; 0 if its energy is no pair energy.
    fn pairs(&self) -> usize {
        0
    }
}

/// Takes the steps of a phase that are left, or fewer if the watch stops the work. Calls `keep` with the state between two
/// steps when the watch wants a checkpoint and when it stops the work. Returns whether all steps are done.
pub(crate) fn work_off<S: State>(
    phase: &mut (impl Phase<S> + ?Sized),
    state: &mut S,
    meter: &mut Meter<'_>,
    keep: &mut dyn FnMut(&S),
) -> bool {
    phase.begin(state);
    while state.steps() < phase.steps() {
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
