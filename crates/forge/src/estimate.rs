//! The cost of a job, estimated from a short trial.

use std::time::{Duration, Instant};

use crate::{ForgeError, Job, curve::LeastCorrelation, plan::Plan};

/// The size and the run time of a job.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number of vectors to find.
    pub blocks: u64,
    /// The largest number of pairs of blocks that a step visits; 0 if its energy is no pair energy.
    pub pairs: u64,
    /// Steps of the optimizer.
    pub steps: u32,
    /// The total number of points that the table will be judged on.
    pub measured_points: u64,
    /// The least pair correlation of a set with the job's power curve, which shows whether any set
    /// can have the curve; `None` for jobs without one.
    pub correlation: Option<LeastCorrelation>,
    /// The run time on this machine, extrapolated from a few evaluations.
    pub time: Duration,
}

/// The number of times that a phase typically builds its neighbor lists.
const LIST_BUILDS: u32 = 5;
/// The time of measuring per point, up to ν = 4, on two cores.
const MEASURING_A_POINT: Duration = Duration::from_nanos(5000);

impl Job {
    /// Estimates the cost of the job from a few evaluations, which take a few percent of its time.
    ///
    /// # Errors
    /// [`ForgeError::Field`] or [`ForgeError::Table`] for a part of the job that is not allowed.
    pub fn estimate(&self) -> Result<Estimate, ForgeError> {
        let plan = Plan::new(self)?;
        let moves = plan.start(self.seed);
        let measured_points = plan.panel.points();
        let mut estimate = Estimate {
            blocks: moves.len() as u64,
            pairs: 0,
            steps: plan.steps,
            measured_points,
            correlation: plan.least_correlation(),
            time: MEASURING_A_POINT * measured_points as u32,
        };
        for phase in plan.phases() {
            let mut objective = phase.objective;
            let mut gradient = vec![[0.0; 2]; moves.len()];
            let began = Instant::now();
            objective.evaluate(&moves, &mut gradient); // builds the neighbor lists
            estimate.time += began.elapsed() * LIST_BUILDS;
            let trials = 2;
            let began = Instant::now();
            for _ in 0..trials {
                objective.evaluate(&moves, &mut gradient);
            }
            estimate.time += began.elapsed() * phase.descent.steps / trials;
            estimate.pairs = estimate.pairs.max(objective.pairs() as u64);
        }
        Ok(estimate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimate_states_the_steps_and_sizes_of_the_job() {
        let job = Job {
            radius: 15,
            steps: Some(40),
            ..Job::new("(5-sqrt(3))/2".parse().expect("valid"))
        };
        let estimate = job.estimate().expect("a good job");
        assert_eq!(estimate.steps, 40);
        assert_eq!(estimate.blocks, 21 * 21);
        assert!(estimate.pairs > 60 * estimate.blocks && estimate.pairs < 300 * estimate.blocks);
        assert!(estimate.measured_points > 3 * 50_000);
        assert!(estimate.time > Duration::ZERO);
    }
}
