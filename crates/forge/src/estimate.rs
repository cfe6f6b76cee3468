//! The cost of a job, estimated from a short trial.

use std::time::{Duration, Instant};

use crate::{
    ForgeError,
    curve::LeastCorrelation,
    forge::{Task, Work as _},
};

/// The size and the run time of a job.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number of vectors to find.
    pub blocks: u64,
    /// The largest number of pairs of blocks that a step visits; 0 if its energy is no pair energy.
    pub pairs: u64,
    pub steps: u32,
    /// About the total number of points that the table will be judged on.
    pub measured_points: u64,
    /// The least pair correlation of a set with the job's power curve, which shows whether any set
    /// can have the curve; `None` for jobs without one.
    pub correlation: Option<LeastCorrelation>,
    /// The run time on this machine, extrapolated from two steps of each phase.
    pub time: Duration,
}

/// The number of times that a phase typically lists its pairs.
const LISTS: u32 = 6;

/// Estimates the cost of a job from a few steps, which take a few percent of its time.
pub fn estimate<J: Task>(job: &J) -> Result<Estimate, ForgeError> {
    let plan = job.plan()?;
    let phases = plan.phases();
    let (_, measured_points, time) = plan.judging();
    let mut estimate = Estimate {
        blocks: 0,
        pairs: 0,
        steps: phases.iter().map(|phase| phase.steps()).sum(),
        measured_points,
        correlation: plan.least_correlation(),
        time: time * measured_points as u32,
    };
    let mut state = plan.start();
    for mut phase in phases {
        phase.begin(&mut state);
        let mut step = || {
            let began = Instant::now();
            phase.step(&mut state);
            began.elapsed()
        };
        // The first one lists the pairs.
        let [first, next] = [step(), step()];
        estimate.time += first.saturating_sub(next) * LISTS + next * phase.steps();
        estimate.pairs = estimate.pairs.max(phase.pairs() as u64);
        state = phase.end(state)?;
    }
    estimate.blocks = (state.moves.len() / J::Plan::AXES) as u64;
    Ok(estimate)
}
