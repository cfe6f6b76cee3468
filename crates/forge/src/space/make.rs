//! Making a table of points in space, from the start or a checkpoint: the phases, the order, the judging.

use strew_core::{Map, space::Table, table::Provenance};

use super::{
    descent::{Descent, SpaceState, push},
    job::{JITTER, SpaceJob, SpaceProfile, Work},
    judge::{Judge, complaints},
    order::with_ranks,
    pairs::{Blocks, longest},
};
use crate::{
    Checkpoint, ForgeError, Meter, Outcome, Stage, Watch,
    checkpoint::{State, other_kind},
    optimize::jitter,
};

/// Makes a table and judges it. A table that misses a bound is no error: see [`Outcome::accepted`].
///
/// # Errors
/// [`ForgeError::Field`] or [`ForgeError::Table`] for a part of the job that is not allowed.
///
/// ```
/// use strew_forge::space::{SpaceJob, SpaceProfile, forge};
///
/// let job = SpaceJob { radius: 3, steps: Some(6), ..SpaceJob::new(SpaceProfile::Blue) };
/// let outcome = forge(&job, &())?;
/// assert_eq!((outcome.table.profile(), outcome.table.map().intervals()), ("blue", 5));
/// // So few steps and blocks do not make a good table.
/// assert!(!outcome.accepted);
/// # Ok::<(), strew_forge::ForgeError>(())
/// ```
pub fn forge(job: &SpaceJob, watch: &dyn Watch) -> Result<Outcome<Table>, ForgeError> {
    run(job, None, watch)
}

/// Resumes a job from a checkpoint. The table is the same as without the interruption.
///
/// # Errors
/// As [`forge()`], and [`ForgeError::Field`] for a checkpoint of another job.
pub fn resume(
    job: &SpaceJob,
    from: Checkpoint,
    watch: &dyn Watch,
) -> Result<Outcome<Table>, ForgeError> {
    run(job, Some(from), watch)
}

impl Checkpoint {
    /// Checks that the checkpoint belongs to a job of points in space.
    ///
    /// # Errors
    /// [`ForgeError::Field`] with the first difference if it does not, [`ForgeError::Field`] or [`ForgeError::Table`] for
    /// a part of the job that is not allowed.
    pub fn is_of_space(&self, job: &SpaceJob) -> Result<(), ForgeError> {
        let maps = job.maps()?;
        let on = &maps[usize::from(self.phase > 0)];
        self.check(&job.identity(), on.intervals().pow(3))
    }
}

fn run(
    job: &SpaceJob,
    from: Option<Checkpoint>,
    watch: &dyn Watch,
) -> Result<Outcome<Table>, ForgeError> {
    let [coarse, map] = job.maps()?;
    let phases = job.phases();
    let all: u32 = phases.iter().map(|phase| phase.steps()).sum();
    let (mut moves, steps) = optimize(job, [&coarse, &map], from, watch)?;
    if moves.len() != map.intervals().pow(3) {
        moves = refined(&coarse, &map, &moves)?;
    }
    let table = table(job, &map, &moves, [steps, all])?;
    let interrupted = |table| Outcome {
        table,
        accepted: false,
        interrupted: true,
        complaints: Vec::new(),
        nearness: None,
    };
    if steps < all {
        return Ok(interrupted(table));
    }
    let judge = Judge::of(&table);
    let mut meter = Meter::new(watch, Stage::Measuring, judge.subjects() + 1);
    if meter.stop() {
        return Ok(interrupted(table));
    }
    let ranked = with_ranks(&table)?;
    meter.advance(None);
    let Some(figures) = judge.figures(&ranked, &mut meter)? else {
        return Ok(interrupted(table));
    };
    let complaints = complaints(job.profile, &figures);
    let provenance = Provenance {
        figures,
        ..ranked.provenance().clone()
    };
    let (vectors, ranks) = (ranked.vectors().to_vec(), ranked.ranks().cloned());
    Ok(Outcome {
        table: Table::new(map, job.profile.name(), vectors, provenance, ranks)?,
        accepted: complaints.is_empty(),
        interrupted: false,
        complaints,
        nearness: None,
    })
}

/// Runs the phases. Returns the vectors and the number of steps; if the watch stopped the work, they may be those of the
/// coarse map.
fn optimize(
    job: &SpaceJob,
    maps: [&Map; 2],
    from: Option<Checkpoint>,
    watch: &dyn Watch,
) -> Result<(Vec<[f64; 3]>, u32), ForgeError> {
    let (phases, identity) = (job.phases(), job.identity());
    let all: u32 = phases.iter().map(|phase| phase.steps()).sum();
    let (first, mut state) = match from {
        None => (0, start(job, maps[0])),
        Some(from) => {
            from.is_of_space(job)?;
            let State::Space(state) = from.state else {
                return Err(other_kind("the plane"));
            };
            (from.phase as usize, state)
        }
    };
    let mut done: u32 = phases.iter().take(first).map(|phase| phase.steps()).sum();
    let checkpoint = |phase: usize, steps, state: &SpaceState| Checkpoint {
        job: identity.clone(),
        phase: phase as u32,
        steps,
        of: all,
        state: State::Space(state.clone()),
    };
    let mut meter = Meter::from(watch, Stage::Optimizing, all, done + state.step);
    for (number, &phase) in phases.iter().enumerate().skip(first) {
        let map = maps[usize::from(number > 0)];
        let blocks = Blocks::new(map, phase.reach());
        let mut descent = match phase {
            Work::Descent(phase) => Some(Descent::new(&blocks, phase, &state)),
            Work::Pushes(_) => None,
        };
        while state.step < phase.steps() {
            let stop = meter.stop();
            if stop || meter.wants_checkpoint() {
                watch.checkpoint(&checkpoint(number, done + state.step, &state));
            }
            if stop {
                return Ok((state.moves, done + state.step));
            }
            let value = match &mut descent {
                Some(descent) => descent.step(&mut state),
                None => push(&blocks, &mut state, phase.steps()),
            };
            meter.advance(Some(value));
        }
        done += state.step;
        let mut moves = match state.best.is_empty() {
            true => state.moves,
            false => state.best,
        };
        // What follows is on the job's own map.
        if moves.len() != maps[1].intervals().pow(3) {
            moves = refined(maps[0], maps[1], &moves)?;
        }
        state = SpaceState {
            moves,
            ..SpaceState::default()
        };
    }
    watch.checkpoint(&checkpoint(phases.len(), done, &state));
    Ok((state.moves, done))
}

/// The random start on a map.
pub(super) fn start(job: &SpaceJob, map: &Map) -> SpaceState {
    SpaceState {
        moves: jitter(map.intervals().pow(3), JITTER, job.seed),
        ..SpaceState::default()
    }
}

/// The table after some of all steps, without figures and ranks.
fn table(
    job: &SpaceJob,
    map: &Map,
    moves: &[[f64; 3]],
    [steps, all]: [u32; 2],
) -> Result<Table, ForgeError> {
    let mut parameters = vec![
        ("pairs".into(), "exact".into()),
        ("longest".into(), longest(job.alpha).to_string()),
        ("steps".into(), all.to_string()),
    ];
    if steps < all {
        parameters.push(("stopped_after".into(), steps.to_string()));
    }
    let provenance = Provenance {
        optimizer: match job.profile {
            SpaceProfile::Blue => "gaussian".into(),
            SpaceProfile::Spaced => "gaussian-push".into(),
        },
        parameters,
        seed: job.seed,
        twins: Vec::new(),
        figures: Vec::new(),
    };
    let vectors = rounded(map, moves);
    let map = map.clone();
    Ok(Table::new(
        map,
        job.profile.name(),
        vectors,
        provenance,
        None,
    )?)
}

/// The vectors of a coarse map for the blocks of a finer one.
pub(super) fn refined(
    coarse: &Map,
    fine: &Map,
    moves: &[[f64; 3]],
) -> Result<Vec<[f64; 3]>, ForgeError> {
    let (fine, parents) = coarse.refine(fine.radius())?;
    let (n, m) = (fine.intervals(), coarse.intervals());
    let parent = |b: usize| {
        let [i, j, k] = [b % n, b / n % n, b / (n * n)].map(|i| parents[i]);
        moves[(k * m + j) * m + i]
    };
    Ok((0..n.pow(3)).map(parent).collect())
}

/// Vectors in mean spacings as those of a table.
fn rounded(map: &Map, moves: &[[f64; 3]]) -> Vec<[i16; 3]> {
    let units = 4096.0 / map.alpha().set_side_f64();
    let round = |v: f64| (v * units).round().clamp(-32_767.0, 32_767.0) as i16;
    moves.iter().map(|v| v.map(round)).collect()
}
