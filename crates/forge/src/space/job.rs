//! A job: the table of points in space to make, the phases of its making, and its bounds.

use std::time::Duration;

use strew_core::{
    Alpha, Map,
    space::Table,
    table::{Figures, Provenance},
};

use super::{
    descent::{Rule, SpacePhase},
    judge::Judge,
    pairs::{COMPONENT, Gaussian, LONGEST, longest, with_ranks},
};
use crate::{
    ForgeError, MAX_STEPS, Meter,
    checkpoint::{State, vectors},
    forge::{Task, Work},
    judge::{Bound, Complaint, Figure, complaints as missed},
    optimize::jitter,
    watch::Phase,
};

/// The table to make. Equal jobs make the same table, bit for bit, on every machine and with any number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceJob {
    pub profile: SpaceProfile,
    pub alpha: Alpha,
    /// The half-width of the map: 16 has 21 intervals at the default α.
    pub radius: u32,
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
    pub const fn name(self) -> &'static str {
        match self {
            Self::Blue => "blue",
            Self::Spaced => "spaced",
        }
    }

    /// The profile with a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|profile| profile.name() == name)
    }
}

impl SpaceJob {
    /// The default job of a profile: α = (5−√3)/2 and 21 intervals.
    ///
    /// # Panics
    /// Never: the text is an α.
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

    /// The maps of the coarse phase and of all others. Fails for a part of the job that is not allowed.
    pub(super) fn maps(&self) -> Result<[Map; 2], ForgeError> {
        if longest(self.alpha) < LEAST_REACH {
            let allowed = "in space at least 1.51: below, vectors are too short";
            return Err(ForgeError::field("alpha", self.alpha, allowed));
        }
        ForgeError::unless_in_range("steps", self.steps.unwrap_or(1), MAX_STEPS)?;
        ForgeError::unless_in_range("R", self.radius, MAX_SPACE_RADIUS)?;
        let coarse = (self.radius * 11).div_ceil(16).max(1);
        let map = Map::new(self.alpha, self.radius)?;
        let intervals = map.intervals();
        // Block numbers fit 16 bits.
        if intervals > MAX_INTERVALS {
            let value = format!("{}, of {intervals} intervals", self.radius);
            let allowed = format!("at most {MAX_INTERVALS} intervals");
            return Err(ForgeError::field("R", value, allowed));
        }
        Ok([Map::new(self.alpha, coarse)?, map])
    }

    /// All phases, in order, with their steps. The first is on the coarse map.
    pub(super) fn phases(&self) -> Vec<(Rule, u32)> {
        let descent = |(sigma, steps)| (Rule::Descent(Gaussian { sigma }), steps);
        let mut phases = [(1.0, 150), (1.0, 120), (0.84, 300)].map(descent).to_vec();
        if self.profile == SpaceProfile::Spaced {
            phases.push((Rule::Pushes, 400));
        }
        if let Some(limit) = self.steps {
            let whole: u64 = phases.iter().map(|(_, steps)| u64::from(*steps)).sum();
            for (_, steps) in &mut phases {
                *steps = (u64::from(*steps) * u64::from(limit) / whole).max(1) as u32;
            }
        }
        phases
    }
}

/// The largest half-width R of a map in space: at the default α 29 intervals.
pub const MAX_SPACE_RADIUS: u32 = 22;
/// The largest number of intervals of a map in space.
const MAX_INTERVALS: usize = 40;
/// The least reach of vectors, in mean spacings.
const LEAST_REACH: f64 = 0.8 * LONGEST;

// Offsets of pairs fit 8 bits.
const _: () = assert!((5.6 + 2.0 * LONGEST) * COMPONENT / LEAST_REACH < 126.0);

/// The reach of the random start along each axis, in mean spacings.
const JITTER: f64 = 0.2;

/// A checked job.
pub struct SpacePlan {
    job: SpaceJob,
    /// Those of the first phase, which is coarse, and of all others.
    maps: [Map; 2],
}

impl Task for SpaceJob {
    type Plan = SpacePlan;

    fn plan(&self) -> Result<SpacePlan, ForgeError> {
        Ok(SpacePlan {
            maps: self.maps()?,
            job: self.clone(),
        })
    }
}

impl SpacePlan {
    fn judge(&self) -> Judge {
        Judge::of(&self.maps[1])
    }
}

impl Work for SpacePlan {
    type Table = Table;
    const AXES: usize = 3;

    fn identity(&self) -> String {
        let SpaceJob { alpha, radius, .. } = self.job;
        let (profile, seed) = (self.job.profile.name(), self.job.seed);
        let longest = longest(alpha);
        format!(
            "points = in space\nprofile = {profile}\nalpha = {alpha}\nR = {radius}\nseed = {seed}\n\
             jitter = {JITTER}\nlongest = {longest}\n"
        )
    }

    fn start(&self) -> State {
        let blocks = self.maps[0].intervals().pow(3);
        State::start(jitter::<3>(blocks, JITTER, self.job.seed).into_flattened())
    }

    fn phases(&self) -> Vec<Box<dyn Phase + '_>> {
        let phases = self.job.phases().into_iter().enumerate();
        let phase = |(number, (rule, steps)): (usize, (Rule, u32))| {
            let finer = (number == 0).then_some(&self.maps);
            let map = &self.maps[usize::from(number > 0)];
            Box::new(SpacePhase::new(rule, steps, map, finer)) as _
        };
        phases.map(phase).collect()
    }

    fn table(
        &self,
        state: &State,
        [steps, all]: [u32; 2],
        figures: Vec<Figures>,
    ) -> Result<Table, ForgeError> {
        let (job, map) = (&self.job, &self.maps[1]);
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
            figures,
        };
        let units = 4096.0 / map.alpha().set_side_f64();
        let round = |v: f64| (v * units).round().clamp(-32_767.0, 32_767.0) as i16;
        let moves = vectors::<3>(&state.moves).iter();
        let vectors = moves.map(|v| v.map(round)).collect();
        let name = job.profile.name();
        Ok(Table::new(map.clone(), name, vectors, provenance, None)?)
    }

    fn judging(&self) -> (u32, u64, Duration) {
        // On one core.
        let time = Duration::from_nanos(15_000);
        (self.judge().subjects(), self.judge().points(), time)
    }

    fn measure(&self, table: &Table, meter: &mut Meter<'_>) -> Option<Vec<Figures>> {
        self.judge().figures(table, meter)
    }

    fn complaints(&self, figures: &[Figures]) -> Vec<Complaint> {
        complaints(self.job.profile, figures)
    }

    fn ranked(&self, table: Table) -> Result<Table, ForgeError> {
        Ok(with_ranks(&table)?)
    }
}

/// The bounds that the figures of a table miss.
fn complaints(profile: SpaceProfile, figures: &[Figures]) -> Vec<Complaint> {
    let [low, seeded_low, least, seeded_least] = match profile {
        SpaceProfile::Blue => [6e-5, 8e-5, 0.66, 0.58],
        SpaceProfile::Spaced => [5e-3, 5e-3, 0.80, 0.72],
    };
    let plain = vec![
        Bound::at_most(Figure::LowPower, low),
        Bound::at_most(Figure::PeakPower, 2.5),
        Bound::at_least(Figure::DeltaMin, least),
        Bound::at_least(Figure::MeanDistance, 0.83),
    ];
    let seeded = vec![
        Bound::at_most(Figure::LowPower, seeded_low),
        Bound::at_most(Figure::PeakPower, 2.3),
        Bound::at_least(Figure::DeltaMin, seeded_least),
    ];
    let local = [
        Bound::at_most(Figure::LocalDeviation, 0.27),
        Bound::at_most(Figure::LocalLargest, 5.0),
    ];
    let of = |figures: &Figures| {
        let is_window = figures.subject.starts_with("window");
        let is_seeded = is_window && figures.subject != "window seed 0";
        let mut bounds = if is_seeded { &seeded } else { &plain }.clone();
        bounds.extend(local.iter().filter(|_| is_window));
        missed(&bounds, std::slice::from_ref(figures))
    };
    figures.iter().flat_map(of).collect()
}
