//! Making a table from the start or a checkpoint: the phases of its optimization, then its judging. One driver works off
//! the jobs of the plane and of space.

use std::time::Duration;

use strew_core::{Table, table::Figures};

use crate::{
    Checkpoint, ForgeError,
    checkpoint::{State, wrong},
    curve::LeastCorrelation,
    judge::{Complaint, Nearness},
    watch::{Meter, Phase, Stage, Watch, work_off},
};

/// A table to make: of the plane, a [`Job`](crate::Job), or of points in space, a [`SpaceJob`](crate::space::SpaceJob).
pub trait Task {
    /// The job, checked.
    type Plan: Work;

    /// Checks every part of the job, which takes a few milliseconds for usual maps.
    fn plan(&self) -> Result<Self::Plan, ForgeError>;
}

/// A checked job, as the driver works it off.
pub trait Work {
    type Table;
    /// The number of components of a vector.
    const AXES: usize;

    /// Everything that decides the result but the phases, as lines of `name = value`. Two jobs with equal lines take the
    /// same steps.
    fn identity(&self) -> String;

    /// The random start.
    fn start(&self) -> State;

    fn phases(&self) -> Vec<Box<dyn Phase + '_>>;

    /// The table after some of all steps, without ranks.
    fn table(
        &self,
        state: &State,
        steps: [u32; 2],
        figures: Vec<Figures>,
    ) -> Result<Self::Table, ForgeError>;

    /// The number of point sets that the table is judged on, about that of their points, and the time that each takes.
    fn judging(&self) -> (u32, u64, Duration);

    /// The figures on these point sets, or `None` if the watch stops the work.
    fn measure(&self, table: &Self::Table, meter: &mut Meter<'_>) -> Option<Vec<Figures>>;

    /// The bounds that the figures miss.
    fn complaints(&self, figures: &[Figures]) -> Vec<Complaint>;

    /// The table with the order in which its points leave, if it has one.
    fn ranked(&self, table: Self::Table) -> Result<Self::Table, ForgeError>;

    /// The least pair correlation of a set with the job's power curve.
    fn least_correlation(&self) -> Option<LeastCorrelation> {
        None
    }
}

/// The table of a job.
pub type TableOf<J> = <<J as Task>::Plan as Work>::Table;

/// The result of a job.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome<T = Table> {
    /// The table with its history. It is usable in any case.
    pub table: T,
    /// Whether the table was judged on unseen point sets and met every bound of its profile.
    pub accepted: bool,
    /// Whether the watch stopped the work. The table is then the best so far, without ranks, and was not judged.
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
pub fn forge<J: Task>(job: &J, watch: &dyn Watch) -> Result<Outcome<TableOf<J>>, ForgeError> {
    run(&job.plan()?, None, watch)
}

/// Resumes a job from a checkpoint. The table is the same as without the interruption.
///
/// # Errors
/// As [`forge()`], and [`ForgeError::Field`] for a checkpoint of another job.
pub fn resume<J: Task>(
    job: &J,
    from: Checkpoint,
    watch: &dyn Watch,
) -> Result<Outcome<TableOf<J>>, ForgeError> {
    run(&job.plan()?, Some(from), watch)
}

impl Checkpoint {
    /// Checks that the checkpoint belongs to `job`.
    pub fn is_of(&self, job: &impl Task) -> Result<(), ForgeError> {
        let plan = job.plan()?;
        self.check(&identity(&plan, &plan.phases()))
    }
}

/// Everything that decides the result of a job.
fn identity<W: Work>(plan: &W, phases: &[Box<dyn Phase + '_>]) -> String {
    let phases = phases
        .iter()
        .map(|phase| format!("phase = {}\n", phase.describe()));
    plan.identity() + &phases.collect::<String>()
}

fn run<W: Work>(
    plan: &W,
    from: Option<Checkpoint>,
    watch: &dyn Watch,
) -> Result<Outcome<W::Table>, ForgeError> {
    let phases = plan.phases();
    let job = identity(plan, &phases);
    let (first, mut state) = match from {
        None => (0, plan.start()),
        Some(from) => {
            from.check(&job)?;
            if !from.state.moves.len().is_multiple_of(W::AXES) {
                return Err(wrong("of another state"));
            }
            (from.phase as usize, from.state)
        }
    };
    let steps = |phases: &[Box<dyn Phase + '_>]| phases.iter().map(|phase| phase.steps()).sum();
    let (count, of): (usize, u32) = (phases.len(), steps(&phases));
    let mut done: u32 = steps(&phases[..first.min(count)]);
    let checkpoint = |phase: usize, steps, state: &State| {
        watch.checkpoint(&Checkpoint {
            job: job.clone(),
            phase: phase as u32,
            steps,
            of,
            state: state.clone(),
        });
    };
    let mut meter = Meter::from(watch, Stage::Optimizing, of, done + state.steps);
    let mut is_done = true;
    for (number, mut phase) in phases.into_iter().enumerate().skip(first) {
        let mut keep = |state: &State| checkpoint(number, done + state.steps, state);
        is_done = work_off(&mut *phase, &mut state, &mut meter, &mut keep);
        done += state.steps;
        state = phase.end(state)?;
        if !is_done {
            break;
        }
    }
    if is_done && count > 0 {
        checkpoint(count, done, &state);
    }
    let table = |figures| plan.table(&state, [done, of], figures);
    let mut outcome = Outcome {
        table: table(Vec::new())?,
        accepted: false,
        interrupted: !is_done,
        complaints: Vec::new(),
        nearness: None,
    };
    if outcome.interrupted {
        return Ok(outcome);
    }
    let mut meter = Meter::new(watch, Stage::Measuring, plan.judging().0);
    let Some(figures) = plan.measure(&outcome.table, &mut meter) else {
        outcome.interrupted = true;
        return Ok(outcome);
    };
    outcome.complaints = plan.complaints(&figures);
    outcome.nearness = Nearness::of(&figures);
    outcome.accepted = outcome.complaints.is_empty();
    outcome.table = plan.ranked(table(figures)?)?;
    Ok(outcome)
}
