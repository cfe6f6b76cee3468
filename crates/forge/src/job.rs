//! A job: which table to make, and what it will cost.

use std::time::{Duration, Instant};

use strew_core::Alpha;

use crate::{
    ForgeError,
    curve::{LeastCorrelation, Target},
    plan::Plan,
};

/// The largest half-width a table is made for: 330 intervals at the default α, and about 200 MB of
/// neighbor lists.
pub const MAX_RADIUS: u32 = 256;
/// The seed unless a job says otherwise. Among the first 18 it gives the flattest spectra: Bragg
/// peaks crowd into rings differently from seed to seed, and on twins far from α the largest radial
/// power comes out between 2.2 and 2.8. The other figures hardly depend on it.
pub const DEFAULT_SEED: u64 = 17;
/// The largest number of steps.
pub const MAX_STEPS: u32 = 1_000_000;

/// Which table to make. Equal jobs make equal tables, bit by bit, on every machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    /// The number α.
    pub alpha: Alpha,
    /// The map's half-width R, 1 to [`MAX_RADIUS`], in grid units: larger maps have more blocks,
    /// which lowers every kind of error and takes longer, both as the square.
    pub radius: u32,
    /// The name of a [`Profile`](crate::Profile).
    pub profile: String,
    /// The seed of the random start.
    pub seed: u64,
    /// A radial power curve to follow, under the name `profile`, which must then be none of the
    /// known ones; `None` for a known profile.
    pub target: Option<Target>,
    /// Steps of the optimizer, 1 to [`MAX_STEPS`]; the profile's own number if `None`. The cost is
    /// proportional; fewer leave power at low frequencies, more sharpen the spectrum's peak.
    pub steps: Option<u32>,
}

impl Job {
    /// The usual job for an α: R = 49, profile `blue`, seed [`DEFAULT_SEED`], the profile's
    /// steps.
    #[must_use]
    pub fn new(alpha: Alpha) -> Self {
        Self {
            alpha,
            radius: 49,
            profile: "blue".into(),
            seed: DEFAULT_SEED,
            target: None,
            steps: None,
        }
    }

    /// What the job will cost, from a few evaluations; takes up to a few percent of that cost.
    ///
    /// # Errors
    /// [`ForgeError::Field`] for a part that is not allowed.
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
            estimate.time += began.elapsed() * NEIGHBOR_LISTS;
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

/// How often neighbor lists are built in a phase of a usual run.
const NEIGHBOR_LISTS: u32 = 5;
/// About what measuring takes, up to ν = 4, on two cores.
const MEASURING_A_POINT: Duration = Duration::from_nanos(5000);

/// What a job will cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number of vectors to find.
    pub blocks: u64,
    /// Pairs of blocks visited in a step, at most; 0 if it is not a matter of pairs.
    pub pairs: u64,
    /// Steps of the optimizer.
    pub steps: u32,
    /// Points of all sets that the table will be judged on.
    pub measured_points: u64,
    /// For a job that follows a power curve, where the pair correlation of its sets is least: tells
    /// whether any set can have the curve.
    pub correlation: Option<LeastCorrelation>,
    /// The time on this machine, as far as a short trial tells.
    pub time: Duration,
}

#[cfg(test)]
mod tests {
    use std::str::FromStr;

    use super::*;
    use crate::forge;

    fn job(steps: u32) -> Job {
        Job {
            radius: 15,
            steps: Some(steps),
            ..Job::new("(5-sqrt(3))/2".parse().expect("valid"))
        }
    }

    #[test]
    fn bad_parts_are_refused_by_name_value_and_what_is_allowed() {
        let good = job(1);
        let of = |alpha: &str| Alpha::from_str(alpha).expect("valid");
        for (job, words) in [
            (
                Job {
                    alpha: of("3/2"),
                    ..good.clone()
                },
                ["alpha", "3/2", "1.1"],
            ),
            (
                Job {
                    alpha: of("1.01"),
                    ..good.clone()
                },
                ["alpha", "101/100", "1.1"],
            ),
            (
                Job {
                    steps: Some(0),
                    ..good.clone()
                },
                ["steps", "0", "1 to 1000000"],
            ),
            (
                Job {
                    steps: Some(u32::MAX),
                    ..good.clone()
                },
                ["steps", "4294967295", "1000000"],
            ),
            (
                Job {
                    radius: 0,
                    ..good.clone()
                },
                ["R", "0", "1 to 256"],
            ),
            (
                Job {
                    radius: 257,
                    ..good.clone()
                },
                ["R", "257", "1 to 256"],
            ),
            (
                Job {
                    profile: "bleu".into(),
                    ..good.clone()
                },
                ["profile", "bleu", "blue"],
            ),
        ] {
            let refused = [
                forge(&job, &()).expect_err("refused"),
                job.estimate().expect_err("refused"),
            ];
            for error in refused.map(|e| e.to_string()) {
                assert!(words.iter().all(|word| error.contains(word)), "{error}");
            }
        }
    }

    #[test]
    fn an_estimate_states_steps_and_sizes_beforehand() {
        let estimate = job(40).estimate().expect("a good job");
        assert_eq!(estimate.steps, 40);
        assert_eq!(estimate.blocks, 21 * 21);
        assert!(estimate.pairs > 60 * estimate.blocks && estimate.pairs < 300 * estimate.blocks);
        assert!(estimate.measured_points > 3 * 50_000);
        assert!(estimate.time > Duration::ZERO);
    }
}
