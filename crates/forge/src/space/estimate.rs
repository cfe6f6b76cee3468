//! The cost of a job of points in space, estimated from a short trial.

use std::time::{Duration, Instant};

use strew_core::Map;

use super::{
    descent::{Descent, push},
    job::{SpaceJob, Work},
    judge::planned_points,
    make::start,
    pairs::Blocks,
};
use crate::ForgeError;

/// The size and the run time of a job.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceEstimate {
    /// The number of vectors to find.
    pub blocks: u64,
    /// Steps of all phases.
    pub steps: u32,
    /// The approximate number of points that the table will be judged on.
    pub measured_points: u64,
    /// The run time on this machine, extrapolated from two steps of each phase.
    pub time: Duration,
}

/// The number of times that a descent typically lists its pairs.
const LISTS: u32 = 8;
/// The steps that making the order takes as long as.
const ORDER: u32 = 40;
/// The time of measuring per point, on one core.
const MEASURING_A_POINT: Duration = Duration::from_nanos(15_000);

impl SpaceJob {
    /// Estimates the cost of the job from a few steps, which take a few percent of its time.
    ///
    /// # Errors
    /// [`ForgeError::Field`] or [`ForgeError::Table`] for a part of the job that is not allowed.
    pub fn estimate(&self) -> Result<SpaceEstimate, ForgeError> {
        let maps = self.maps()?;
        let phases = self.phases();
        let measured_points = planned_points(&maps[1]);
        let mut time = MEASURING_A_POINT * measured_points as u32;
        for (number, &phase) in phases.iter().enumerate() {
            let map: &Map = &maps[usize::from(number > 0)];
            let blocks = Blocks::new(map, phase.reach());
            let mut state = start(self, map);
            let began = Instant::now();
            match phase {
                Work::Descent(phase) => {
                    let mut descent = Descent::new(&blocks, phase, &state);
                    descent.step(&mut state);
                    let first = began.elapsed();
                    let began = Instant::now();
                    descent.step(&mut state);
                    let next = began.elapsed();
                    time += first.saturating_sub(next) * LISTS + next * phase.steps;
                    if number == 1 {
                        time += next * ORDER;
                    }
                }
                Work::Pushes(steps) => {
                    push(&blocks, &mut state, steps);
                    time += began.elapsed() * steps;
                }
            }
        }
        Ok(SpaceEstimate {
            blocks: maps[1].intervals().pow(3) as u64,
            steps: phases.iter().map(|phase| phase.steps()).sum(),
            measured_points,
            time,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::SpaceProfile;

    #[test]
    fn an_estimate_states_the_steps_and_sizes_of_the_job() {
        let job = SpaceJob {
            radius: 5,
            steps: Some(97),
            ..SpaceJob::new(SpaceProfile::Spaced)
        };
        let estimate = job.estimate().expect("allowed");
        assert_eq!((estimate.blocks, estimate.steps), (343, 97));
        assert!(estimate.measured_points > 10_000 && estimate.time > Duration::ZERO);
    }
}
