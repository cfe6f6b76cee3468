//! Making a table of points in space.

use strew_core::{Alpha, Map, space::Table, table::Provenance};

use super::{
    descent::{Descent, Phase, State},
    pairs::{Blocks, LONGEST},
    push::push,
};
use crate::{ForgeError, Meter, Stage, Watch, numeric::SplitMix};

/// The table to make.
///
/// ```
/// use strew_forge::space::{SpaceJob, SpaceProfile, forge};
///
/// let job = SpaceJob { radius: 5, steps: Some(12), ..SpaceJob::new(SpaceProfile::Blue) };
/// let table = forge(&job, &())?.expect("not stopped");
/// assert_eq!((table.profile(), table.map().intervals()), ("blue", 7));
/// # Ok::<(), strew_forge::ForgeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceJob {
    /// The noise profile.
    pub profile: SpaceProfile,
    /// The α of the pattern.
    pub alpha: Alpha,
    /// The half-width of the map: 16 has 21 intervals at the default α.
    pub radius: u32,
    /// The seed of the random start.
    pub seed: u64,
    /// The number of steps of all phases together; the profile's own if `None`.
    pub steps: Option<u32>,
}

/// A noise profile of points in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpaceProfile {
    /// Blue noise: a low Gaussian energy.
    Blue,
    /// Points as far apart as they go: blue noise, then pushes.
    Spaced,
}

impl SpaceProfile {
    /// All profiles.
    pub const ALL: [Self; 2] = [Self::Blue, Self::Spaced];

    /// The name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Blue => "blue",
            Self::Spaced => "spaced",
        }
    }

    /// The profile with a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|profile| profile.name() == name)
    }
}

impl SpaceJob {
    /// The default job of a profile: α = (5−√3)/2 and 21 intervals.
    ///
    /// # Panics
    /// Never: the text is an α.
    #[must_use]
    pub fn new(profile: SpaceProfile) -> Self {
        let alpha = "(5-sqrt(3))/2".parse();
        Self {
            profile,
            alpha: alpha.unwrap_or_else(|error| unreachable!("{error}")),
            radius: 16,
            seed: 1,
            steps: None,
        }
    }

    /// The phases on a coarse map, on the job's own, and the number of pushes.
    fn phases(&self) -> ([Vec<Phase>; 2], u32) {
        let all = [(1.0, 150), (1.0, 120), (0.84, 300)];
        let whole: u32 = all.iter().map(|(_, steps)| steps).sum();
        let pushes = match self.profile {
            SpaceProfile::Blue => 0,
            SpaceProfile::Spaced => 400,
        };
        let part = |steps: u32| match self.steps {
            Some(limit) => {
                (u64::from(steps) * u64::from(limit) / u64::from(whole + pushes)).max(1) as u32
            }
            None => steps,
        };
        let phase = |(sigma, steps): (f64, u32)| Phase {
            sigma,
            steps: part(steps),
        };
        let phases = [vec![phase(all[0])], vec![phase(all[1]), phase(all[2])]];
        (phases, if pushes == 0 { 0 } else { part(pushes) })
    }
}

/// The reach of the random start along each axis, in mean spacings.
const JITTER: f64 = 0.2;

/// Makes a table. Equal jobs make the same table, bit for bit, on every machine. Returns `None` if the watch stopped the
/// work.
///
/// # Errors
/// [`ForgeError::Table`] for a part of the job that is not allowed.
pub fn forge(job: &SpaceJob, watch: &dyn Watch) -> Result<Option<Table>, ForgeError> {
    let map = Map::new(job.alpha, job.radius)?;
    let coarse = Map::new(job.alpha, (job.radius * 11).div_ceil(16).max(1))?;
    let (phases, pushes) = job.phases();
    let steps = phases
        .iter()
        .flatten()
        .map(|phase| phase.steps)
        .sum::<u32>()
        + pushes;
    let mut meter = Meter::new(watch, Stage::Optimizing, steps);
    let mut random = SplitMix::new(job.seed);
    let mut jitter = || (2.0 * random.next_f64() - 1.0) * JITTER;
    let mut moves: Vec<[f64; 3]> = (0..coarse.intervals().pow(3))
        .map(|_| [jitter(), jitter(), jitter()])
        .collect();
    for (map, phases) in [&coarse, &map].into_iter().zip(&phases) {
        let blocks = Blocks::new(map, 5.6);
        if moves.len() != blocks.shares.len() {
            moves = refined(&coarse, map, &moves)?;
        }
        for phase in phases {
            let mut state = State::start(moves);
            let mut descent = Descent::new(&blocks, *phase, &state);
            for _ in 0..phase.steps {
                if meter.stop() {
                    return Ok(None);
                }
                let energy = descent.step(&mut state);
                meter.advance(Some(energy));
            }
            moves = state.moves;
        }
    }
    if pushes > 0 {
        let blocks = Blocks::new(&map, 1.3);
        if !push(&blocks, &mut moves, pushes, &mut meter) {
            return Ok(None);
        }
    }
    let provenance = Provenance {
        optimizer: match job.profile {
            SpaceProfile::Blue => "gaussian".into(),
            SpaceProfile::Spaced => "gaussian-push".into(),
        },
        parameters: vec![
            ("pairs".into(), "exact".into()),
            ("longest".into(), LONGEST.to_string()),
            ("steps".into(), steps.to_string()),
        ],
        seed: job.seed,
        twins: Vec::new(),
        figures: Vec::new(),
    };
    let vectors = rounded(&map, &moves);
    Ok(Some(Table::new(
        map,
        job.profile.name(),
        vectors,
        provenance,
        None,
    )?))
}

/// The vectors of a coarse map for the blocks of a finer one.
fn refined(coarse: &Map, fine: &Map, moves: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, ForgeError> {
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
