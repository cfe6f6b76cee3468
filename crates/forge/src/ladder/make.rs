//! Making a ladder: start, polish, clearance, judging.

use strew_core::{
    Table,
    table::{Figures, Ladder},
};

use super::{
    clearance::{Clearance, clear, clearance},
    climb::{Blocks, Climb},
    events,
    judge::{bounds_missed, judge},
    order::with_ranks,
    polish::Polish,
    segment::Energy,
};
use crate::{
    Checkpoint, ForgeError,
    judge::Complaint,
    optimize::DescentState,
    watch::{Meter, Stage, Watch},
};

/// Raised with any change that makes other ladders.
const ARITHMETIC: u32 = 1;
/// σ = 0.85: a wider Gaussian leaves more power below ν = 0.5 than there is without any polish.
const ENERGY: Energy = Energy {
    sigma: 0.85,
    guard: 0.8,
    strength: 0.3,
};
/// Shares looked at in each segment and step.
const SAMPLES: usize = 3;
/// Neighbor lists are made again after this many steps.
const LISTING: u32 = 15;
/// The part of the steps after which they become shorter, and how short.
const SLOWING: (f64, f64) = (0.75, 0.4);
/// The δ to which pairs are pushed apart: more than what is promised, because vectors are rounded later.
const CLEAR: f64 = 0.53;
/// The most rounds of pushing.
const ROUNDS: usize = 80;
/// The longest way of a block from its lattice address, in mean spacings of the thinned set.
const ROAM: f64 = 3.0;

/// The ladder to make.
///
/// ```
/// use strew_forge::LadderJob;
///
/// let job = LadderJob::default();
/// assert_eq!((job.per_octave, job.octaves), (16, 6)); // 96 levels, down to a share of 1/64
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LadderJob {
    /// Levels each time the share halves, 1 to 32. Low power is about in proportion to 1/`per_octave`, and
    /// the size of the ladder to `per_octave`.
    pub per_octave: u32,
    /// The number of times that the share halves, 1 to 8.
    pub octaves: u32,
    /// Steps of the polish, 1 to 10,000. From 60 on more of them change little.
    pub steps: u32,
}

impl Default for LadderJob {
    fn default() -> Self {
        Self {
            per_octave: 16,
            octaves: 6,
            steps: 100,
        }
    }
}

impl LadderJob {
    fn check(&self) -> Result<(), ForgeError> {
        let fields = [
            ("per_octave", self.per_octave, 32),
            ("octaves", self.octaves, 8),
            ("steps", self.steps, 10_000),
        ];
        for (field, value, most) in fields {
            if !(1..=most).contains(&value) {
                return Err(ForgeError::Field {
                    field,
                    value: value.to_string(),
                    allowed: format!("from 1 to {most}"),
                });
            }
        }
        Ok(())
    }

    /// The shares of the levels below 1: λ = 2^(−k/`per_octave`), rounded to the 2⁻³² of a table file.
    fn shares(&self) -> Vec<f64> {
        let share = |k: u32| libm::exp2(-f64::from(k) / f64::from(self.per_octave));
        let rounded = |share: f64| (share * 4_294_967_296.0).round() / 4_294_967_296.0;
        let levels = 1..=self.per_octave * self.octaves;
        levels.map(|k| rounded(share(k))).collect()
    }

    /// Everything that decides the result.
    fn identity(&self, table: &Table) -> String {
        let Self {
            per_octave,
            octaves,
            steps,
        } = self;
        format!(
            "ladder of = {}\nper octave = {per_octave}\noctaves = {octaves}\nsteps = {steps}\n\
             arithmetic = {ARITHMETIC}\n",
            table.digest()
        )
    }
}

/// The result of making a ladder.
#[derive(Clone, Debug, PartialEq)]
pub struct LadderOutcome {
    /// The table with its ladder. It is usable in any case.
    pub table: Table,
    /// Whether the ladder met every bound, at shares and on twins that it was not made with.
    pub accepted: bool,
    /// Whether the watch stopped the work. The ladder is then the best so far and was not judged.
    pub interrupted: bool,
    /// The measurements: for each octave of shares and twin the greatest and the mean low power and the
    /// least δ, and the least δ of the unbounded set, exactly.
    pub figures: Vec<Figures>,
    /// The bounds that the ladder missed.
    pub complaints: Vec<Complaint>,
}

/// Makes a ladder for a table: displacements for the blocks that are left at smaller shares. A table
/// without ranks gets them first. The table's own vectors are not changed.
///
/// Equal tables and jobs make the same ladder, bit for bit, with any number of threads, and when resumed
/// from a checkpoint.
///
/// # Errors
/// [`ForgeError::Field`] for a part of the job that is not allowed or a checkpoint of another job,
/// [`ForgeError::Table`] if the result is no valid table.
///
/// ```
/// use strew_core::Table;
/// use strew_forge::{LadderJob, ladder};
///
/// let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 12, "pattern")?;
/// let job = LadderJob { per_octave: 2, octaves: 1, steps: 3 }; // tiny, for the example
/// let outcome = ladder(&table, &job, None, &())?;
/// assert_eq!(outcome.table.displacements(), table.displacements());
/// let made = outcome.table.ladder().expect("one");
/// assert_eq!(made.least_share(), 0.5);
/// assert!(!outcome.figures.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn ladder(
    table: &Table,
    job: &LadderJob,
    from: Option<Checkpoint>,
    watch: &dyn Watch,
) -> Result<LadderOutcome, ForgeError> {
    job.check()?;
    let table = match table.ranks() {
        Some(_) => table.clone(),
        None => with_ranks(table)?,
    };
    let shares = job.shares();
    let least = shares.last().copied().unwrap_or(1.0);
    let reach = (ENERGY.cutoff() + 2.0 * ROAM + 1.0) / least.sqrt();
    let Some(blocks) = Blocks::new(&table, reach) else {
        unreachable!("the table has ranks");
    };
    let mut climb = Climb::start(&table, &blocks, &shares);
    events::time(&blocks, &mut climb);
    let done = polish(&table, job, &blocks, &mut climb, from, watch)?;
    let clearance = settle(&blocks, &mut climb);
    let scale = blocks.ground.scale();
    let mut outcome = LadderOutcome {
        table: table.with_ladder(climb.ladder(scale)?)?,
        accepted: false,
        interrupted: !done,
        figures: Vec::new(),
        complaints: Vec::new(),
    };
    if outcome.interrupted {
        return Ok(outcome);
    }
    let Some(mut figures) = judge(&outcome.table, watch) else {
        outcome.interrupted = true;
        return Ok(outcome);
    };
    figures.insert(0, exactly(&clearance));
    outcome.complaints = bounds_missed(&outcome.table, &figures);
    outcome.accepted = outcome.complaints.is_empty();
    outcome.figures = figures;
    Ok(outcome)
}

impl LadderOutcome {
    /// The ladder that was made.
    #[must_use]
    pub fn ladder(&self) -> Option<&Ladder> {
        self.table.ladder()
    }
}

/// Descends. Returns whether it was not interrupted.
fn polish(
    table: &Table,
    job: &LadderJob,
    blocks: &Blocks,
    climb: &mut Climb,
    from: Option<Checkpoint>,
    watch: &dyn Watch,
) -> Result<bool, ForgeError> {
    let identity = job.identity(table);
    let vectors = climb.counts.iter().sum();
    let mut first = 0;
    let mut polish = match from {
        None => Polish::new(blocks, climb, ENERGY, SAMPLES),
        Some(from) => {
            from.check(&identity, vectors)?;
            first = from.steps();
            let state = from.state;
            climb.set_moves(&state.prepared_for);
            let mut polish = Polish::new(blocks, climb, ENERGY, SAMPLES);
            climb.set_moves(&state.moves);
            polish.set_velocities(&state.at);
            polish
        }
    };
    let mut meter = Meter::from(watch, Stage::Optimizing, job.steps, first);
    for step in first..job.steps {
        if step > 0 && step % LISTING == 0 {
            polish.list(blocks, climb);
        }
        let stop = meter.stop();
        if stop || meter.wants_checkpoint() {
            let mut state = DescentState::start(climb.moves.concat());
            state.steps = step;
            state.at = polish.velocities();
            state.prepared_for = polish.listed_for();
            watch.checkpoint(&Checkpoint {
                job: identity.clone(),
                phase: 0,
                steps: step,
                of: job.steps,
                state,
            });
        }
        if stop {
            return Ok(false);
        }
        let is_late = f64::from(step) > SLOWING.0 * f64::from(job.steps);
        let pace = if is_late { SLOWING.1 } else { 1.0 };
        let energy = polish.step(blocks, climb, step, pace);
        meter.advance(Some(energy));
    }
    Ok(true)
}

/// Pushes near pairs apart and rounds to what a file holds. Returns the distances after that.
fn settle(blocks: &Blocks, climb: &mut Climb) -> Clearance {
    // Events are rounded first: they decide when pairs meet.
    climb.quantize_events();
    clear(blocks, climb, CLEAR, ROUNDS);
    climb.quantize(blocks.ground.scale());
    clearance(blocks, climb)
}

/// The exact least distance as figures.
fn exactly(clearance: &Clearance) -> Figures {
    Figures {
        subject: "all shares, exactly".into(),
        seen: false,
        points: 0,
        values: vec![("delta_min".into(), clearance.delta_min())],
    }
}
