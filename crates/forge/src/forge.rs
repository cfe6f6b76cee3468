//! Making a table from the start or a checkpoint: the phases of its optimization, then its judging.

use strew_core::{Table, table::Provenance};

use crate::{
    Checkpoint, ForgeError, Job,
    checkpoint::{State, other_kind},
    judge::{Complaint, Nearness, complaints},
    optimize::DescentState,
    plan::Plan,
    thinned::with_ranks,
    watch::{Meter, Stage, Watch},
};

/// The result of a job.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome<T = Table> {
    /// The table with its history. It is usable in any case.
    pub table: T,
    /// Whether the table was judged on unseen point sets and met every bound of its profile.
    pub accepted: bool,
    /// Whether the watch stopped the work. The table is then the best so far, in space without ranks, and was not judged.
    pub interrupted: bool,
    /// The bounds that the table missed.
    pub complaints: Vec<Complaint>,
    /// The distance of the table from its power curve; `None` if it follows none or was not judged.
    pub nearness: Option<Nearness>,
}

/// Makes a table and judges it. A table that misses a bound is no error: see [`Outcome::accepted`].
///
/// # Errors
/// [`ForgeError::Field`] or [`ForgeError::Table`] for a part of the job that is not allowed.
pub fn forge(job: &Job, watch: &dyn Watch) -> Result<Outcome, ForgeError> {
    run(job, None, watch)
}

/// Resumes a job from a checkpoint. The table is the same as without the interruption.
///
/// # Errors
/// As [`forge()`], and [`ForgeError::Field`] for a checkpoint of another job.
///
/// ```
/// use std::sync::Mutex;
/// use strew_forge::{Checkpoint, Job, Progress, Watch, forge, resume};
///
/// /// Stops after five steps and keeps the checkpoint.
/// #[derive(Default)]
/// struct Stopper(Mutex<(u32, Option<Checkpoint>)>);
///
/// impl Watch for Stopper {
///     fn progress(&self, progress: &Progress) {
///         self.0.lock().unwrap().0 = progress.step;
///     }
///
///     fn stop(&self) -> bool {
///         self.0.lock().unwrap().0 == 5
///     }
///
///     fn checkpoint(&self, checkpoint: &Checkpoint) {
///         self.0.lock().unwrap().1 = Some(checkpoint.clone());
///     }
/// }
///
/// let mut job = Job::new("sqrt(3)".parse()?);
/// (job.radius, job.steps) = (12, Some(20)); // tiny, for the example
/// let stopper = Stopper::default();
/// assert!(forge(&job, &stopper)?.interrupted);
/// let (steps, checkpoint) = stopper.0.into_inner()?;
/// let resumed = resume(&job, checkpoint.expect("kept when it stopped"), &())?;
/// assert_eq!((steps, resumed), (5, forge(&job, &())?));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn resume(job: &Job, from: Checkpoint, watch: &dyn Watch) -> Result<Outcome, ForgeError> {
    run(job, Some(from), watch)
}

impl Checkpoint {
    /// Checks that the checkpoint belongs to `job`.
    ///
    /// # Errors
    /// [`ForgeError::Field`] with the first difference if it does not, [`ForgeError::Field`] or
    /// [`ForgeError::Table`] for a part of the job that is not allowed.
    pub fn is_of(&self, job: &Job) -> Result<(), ForgeError> {
        let plan = Plan::new(job)?;
        self.check(&plan.identity(job, &plan.phases()), plan.blocks())
    }
}

fn run(job: &Job, from: Option<Checkpoint>, watch: &dyn Watch) -> Result<Outcome, ForgeError> {
    let plan = Plan::new(job)?;
    let done = optimize(&plan, job, from, watch)?;
    let provenance = plan.provenance(job, done.steps);
    let mut outcome = Outcome {
        table: plan.table(&done.moves, provenance.clone())?,
        accepted: false,
        interrupted: done.interrupted,
        complaints: Vec::new(),
        nearness: None,
    };
    if outcome.interrupted {
        return Ok(outcome);
    }
    let mut meter = Meter::new(watch, Stage::Measuring, plan.panel.subjects());
    let Some(figures) = plan.panel.measure(&outcome.table, &mut meter) else {
        outcome.interrupted = true;
        return Ok(outcome);
    };
    outcome.complaints = complaints(&plan.bounds, &figures);
    outcome.nearness = Nearness::of(&figures);
    outcome.accepted = outcome.complaints.is_empty();
    let judged = Provenance {
        figures,
        ..provenance
    };
    outcome.table = plan.table(&done.moves, judged)?;
    // Without a least distance a thinned set would have another profile.
    if outcome.table.least_distance().is_useful() {
        outcome.table = with_ranks(&outcome.table)?;
    }
    Ok(outcome)
}

/// The result of the optimizer.
struct Optimized {
    /// The vectors, in mean spacings.
    moves: Vec<[f64; 2]>,
    /// Steps done in all phases.
    steps: u32,
    interrupted: bool,
}

fn optimize(
    plan: &Plan,
    job: &Job,
    from: Option<Checkpoint>,
    watch: &dyn Watch,
) -> Result<Optimized, ForgeError> {
    let phases = plan.phases();
    let count = phases.len();
    let identity = plan.identity(job, &phases);
    let (first, mut state) = match from {
        None => (0, DescentState::start(plan.start(job.seed))),
        Some(from) => {
            from.check(&identity, plan.blocks())?;
            let State::Plane(state) = from.state else {
                return Err(other_kind("points in space"));
            };
            (from.phase as usize, state)
        }
    };
    let checkpoint = |phase: usize, steps, state: &DescentState| Checkpoint {
        job: identity.clone(),
        phase: phase as u32,
        steps,
        of: plan.steps,
        state: State::Plane(state.clone()),
    };
    let before = phases.iter().take(first).map(|phase| phase.descent.steps);
    let mut steps: u32 = before.sum();
    let mut meter = Meter::from(watch, Stage::Optimizing, plan.steps, steps + state.steps);
    for (at, mut phase) in phases.into_iter().enumerate().skip(first) {
        let mut keep =
            |state: &DescentState| watch.checkpoint(&checkpoint(at, steps + state.steps, state));
        state = phase
            .descent
            .run(&mut *phase.objective, state, &mut meter, &mut keep);
        steps += state.steps;
        if state.steps < phase.descent.steps {
            return Ok(Optimized {
                moves: state.moves,
                steps,
                interrupted: true,
            });
        }
        state = DescentState::start(state.moves);
    }
    if count > 0 {
        watch.checkpoint(&checkpoint(count, steps, &state));
    }
    Ok(Optimized {
        moves: state.moves,
        steps,
        interrupted: false,
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

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
    fn the_history_records_recipe_twins_and_figures() {
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

    /// Records all progress, and stops the work at a step of a stage.
    struct Recorder {
        stop_at: (Stage, u32),
        reported: Mutex<Vec<Progress>>,
    }

    impl Watch for Recorder {
        fn progress(&self, progress: &Progress) {
            self.reported.lock().expect("no panic").push(*progress);
        }

        fn stop(&self) -> bool {
            let reported = self.reported.lock().expect("no panic");
            reported
                .last()
                .is_some_and(|p| (p.stage, p.step) == self.stop_at)
        }
    }

    #[test]
    fn every_step_is_reported_and_can_be_the_last() {
        let stages = [
            (Stage::Optimizing, 0),
            (Stage::Optimizing, 5),
            (Stage::Optimizing, 11),
        ];
        for (stage, step) in stages.into_iter().chain([(Stage::Measuring, 2)]) {
            let recorder = Recorder {
                stop_at: (stage, step),
                reported: Mutex::default(),
            };
            let outcome = forge(&job(12), &recorder).expect("a good job");
            assert!(outcome.interrupted && !outcome.accepted, "{stage:?} {step}");
            assert!(outcome.table.provenance().figures.is_empty());
            assert!(Table::from_bytes(&outcome.table.to_bytes()).is_ok());
            let reported = recorder.reported.into_inner().expect("no panic");
            let optimizing = reported.iter().filter(|p| p.stage == Stage::Optimizing);
            let steps: Vec<u32> = optimizing.map(|p| p.step).collect();
            let last = if stage == Stage::Optimizing { step } else { 12 };
            assert_eq!(steps, (0..=last).collect::<Vec<_>>());
            assert!(
                reported
                    .iter()
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
}
