//! A job: which table to make, what it will cost, and the making.

use std::time::{Duration, Instant};

use strew_core::{Alpha, Table, table::Provenance};

use crate::{
    ForgeError,
    judge::{Complaint, complaints},
    optimize::{Descended, Meter, Stage, Watch},
    plan::Plan,
    profile::Target,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Estimate {
    /// The number of vectors to find.
    pub blocks: u64,
    /// Pairs of blocks visited in a step, at most; 0 if it is not a matter of pairs.
    pub pairs: u64,
    /// Steps of the optimizer.
    pub steps: u32,
    /// Points of all sets that the table will be judged on.
    pub measured_points: u64,
    /// The time on this machine, as far as a short trial tells.
    pub time: Duration,
}

/// What became of a job.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The table, with its history. Usable in any case.
    pub table: Table,
    /// Whether it was measured on unseen subjects and met every bound of its profile.
    pub accepted: bool,
    /// Whether the watch stopped the work: the table is the best until then, and was not judged.
    pub interrupted: bool,
    /// The bounds it missed.
    pub complaints: Vec<Complaint>,
}

/// Makes a table and judges it. A table that misses a bound is an outcome, not an error.
///
/// # Errors
/// [`ForgeError::Field`] for a part of the job that is not allowed.
pub fn forge(job: &Job, watch: &dyn Watch) -> Result<Outcome, ForgeError> {
    let plan = Plan::new(job)?;
    let mut meter = Meter::new(watch, Stage::Optimizing, plan.steps);
    let mut done = Descended::at(plan.start(job.seed));
    let mut steps = 0;
    for mut phase in plan.phases() {
        done = phase
            .descent
            .run(&mut *phase.objective, done.moves, &mut meter);
        steps += done.steps;
        if done.interrupted {
            break;
        }
    }
    let provenance = plan.provenance(job, steps);
    let table = plan.table(&done.moves, provenance.clone())?;
    let mut outcome = Outcome {
        table,
        accepted: false,
        interrupted: done.interrupted,
        complaints: Vec::new(),
    };
    if done.interrupted {
        return Ok(outcome);
    }
    let mut meter = Meter::new(watch, Stage::Measuring, plan.panel.subjects());
    let Some(figures) = plan.panel.measure(&outcome.table, &mut meter) else {
        outcome.interrupted = true;
        return Ok(outcome);
    };
    outcome.complaints = complaints(plan.profile.bounds, &figures);
    outcome.accepted = outcome.complaints.is_empty();
    let judged = Provenance {
        figures,
        ..provenance
    };
    outcome.table = plan.table(&done.moves, judged)?;
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use std::{str::FromStr, sync::Mutex};

    use strew_core::Twin;

    use super::*;
    use crate::Progress;

    fn job(steps: u32) -> Job {
        Job {
            radius: 15,
            steps: Some(steps),
            ..Job::new("(5-sqrt(3))/2".parse().expect("valid"))
        }
    }

    #[test]
    fn equal_jobs_make_equal_tables_with_any_number_of_threads() {
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let outcome = pool.expect("threads").install(|| forge(&job(30), &()));
            outcome.expect("a good job").table
        };
        let table = with(1);
        assert_eq!(with(2), table);
        assert_eq!(with(5), table);
        let other = Job { seed: 2, ..job(30) };
        let other = forge(&other, &()).expect("a good job").table;
        assert_ne!(other.displacements(), table.displacements());
    }

    #[test]
    fn the_history_tells_all() {
        let outcome = forge(&job(30), &()).expect("a good job");
        let history = outcome.table.provenance();
        assert_eq!((history.optimizer.as_str(), history.seed), ("gaussian", 17));
        assert!(history.parameters.contains(&("steps".into(), "30".into())));
        assert!(history.parameters.contains(&("sigma".into(), "1".into())));
        assert_eq!(history.twins.len(), 6);
        for figures in &history.figures {
            let twin = |t: &Twin| figures.subject == format!("twin {t}");
            assert_eq!(
                figures.seen,
                history.twins.iter().any(twin),
                "{}",
                figures.subject
            );
            assert!(
                figures.seen || figures.points >= 50_000,
                "{}",
                figures.subject
            );
        }
        assert!(
            history
                .figures
                .iter()
                .any(|f| f.subject.starts_with("window"))
        );
        assert_eq!(outcome.accepted, outcome.complaints.is_empty());
        let back = Table::from_bytes(&outcome.table.to_bytes()).expect("valid");
        assert_eq!(back, outcome.table);
    }

    /// Notes all it is told, and stops the work at a step of a stage.
    struct Observer {
        stop_at: (Stage, u32),
        told: Mutex<Vec<Progress>>,
    }

    impl Watch for Observer {
        fn progress(&self, progress: &Progress) {
            self.told.lock().expect("no panic").push(*progress);
        }

        fn stop(&self) -> bool {
            let told = self.told.lock().expect("no panic");
            told.last()
                .is_some_and(|p| (p.stage, p.step) == self.stop_at)
        }
    }

    #[test]
    fn a_watch_is_told_every_step_and_can_stop_at_any() {
        let stages = [
            (Stage::Optimizing, 0),
            (Stage::Optimizing, 5),
            (Stage::Optimizing, 11),
        ];
        for (stage, step) in stages.into_iter().chain([(Stage::Measuring, 2)]) {
            let observer = Observer {
                stop_at: (stage, step),
                told: Mutex::default(),
            };
            let outcome = forge(&job(12), &observer).expect("a good job");
            assert!(outcome.interrupted && !outcome.accepted, "{stage:?} {step}");
            assert!(outcome.table.provenance().figures.is_empty());
            assert!(Table::from_bytes(&outcome.table.to_bytes()).is_ok());
            let told = observer.told.into_inner().expect("no panic");
            let optimizing = told.iter().filter(|p| p.stage == Stage::Optimizing);
            let steps: Vec<u32> = optimizing.map(|p| p.step).collect();
            let last = if stage == Stage::Optimizing { step } else { 12 };
            assert_eq!(steps, (0..=last).collect::<Vec<_>>());
            assert!(
                told.iter()
                    .all(|p| p.stage == Stage::Measuring || p.steps == 12)
            );
            let stopped_after = ("stopped_after".into(), step.to_string());
            let says_so = outcome
                .table
                .provenance()
                .parameters
                .contains(&stopped_after);
            assert_eq!(says_so, stage == Stage::Optimizing);
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
    fn the_smallest_jobs_work() {
        for alpha in ["1.11", "1.95", "183/112", "sqrt(2)"] {
            let job = Job {
                radius: 1,
                steps: Some(1),
                ..Job::new(alpha.parse().expect("valid"))
            };
            let outcome = forge(&job, &()).expect("a good job");
            assert!(!outcome.accepted, "{alpha}");
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
