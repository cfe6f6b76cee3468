//! A job: the table to make; what is known of it before it is made; and the job checked, with its profile, the domain it is
//! optimized on, and the panel it is judged on.

use std::{fmt, time::Duration};

use strew_core::{
    ALGORITHM_VERSION, Alpha, Map, Table, Twin,
    table::{FORMAT_VERSION, Figures, Provenance, from_grid_units},
};

use crate::{
    ForgeError,
    checkpoint::{State, vectors},
    curve::{LeastCorrelation, Target, to_parameters},
    forge::{Task, Work},
    judge::{Bound, Complaint, Panel, bounds_of_curve, complaints},
    optimize::jitter,
    order::with_ranks,
    profile::{Profile, Recipe},
    twins::Domain,
    watch::{Meter, Phase},
};

/// The largest half-width R: 330 intervals at the default α, about 200 MB of neighbor lists.
pub const MAX_RADIUS: u32 = 256;
/// The default seed. Of the first 18 seeds it yields the flattest spectra: Bragg peaks crowd into
/// rings differently from seed to seed, and the largest radial power on twins far from α varies
/// from 2.2 to 2.8. The other figures hardly depend on the seed.
pub const DEFAULT_SEED: u64 = 17;
/// The largest number of optimizer steps.
pub const MAX_STEPS: u32 = 1_000_000;

/// The table to make. Equal jobs make the same table, bit for bit, on every machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    pub alpha: Alpha,
    /// The half-width R of the map, 1 to [`MAX_RADIUS`], in grid units. Larger maps have more
    /// blocks: every kind of error falls, and the run time grows, as the square of R.
    pub radius: u32,
    /// The name of a [`Profile`](crate::Profile), or with a `target` a new name.
    pub profile: String,
    pub seed: u64,
    /// A custom radial power curve to follow; `None` for the built-in profiles.
    pub target: Option<Target>,
    /// Steps of the optimizer, 1 to [`MAX_STEPS`]; `None` for the default of the profile. Run time
    /// is proportional to it. Fewer steps leave power at low frequencies, more sharpen the peak of
    /// the spectrum.
    pub steps: Option<u32>,
}

impl Job {
    /// The default job for an α: R = 49, profile `blue`, seed [`DEFAULT_SEED`], the default steps.
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
}

/// The least side t of the set region, that of α = 1.1. Below it a map of any half-width covers too
/// few neighbors, with too many grid points between them to list.
pub(crate) const MIN_SIDE: f64 = 0.05;

/// The largest half-width for a radial power curve: its neighbor lists take 1 to 2 GB there.
const MAX_RADIAL_RADIUS: u32 = 200;
/// The version of the optimizer's arithmetic. Any change of a step's result, down to the last bit,
/// raises it, so that work begun before the change is not resumed after it.
const ARITHMETIC: u32 = 2;

/// A checked job.
pub struct Plan {
    job: Job,
    /// For a custom curve its name differs from that of the job's.
    profile: &'static Profile,
    /// The radial power curve to follow, if any.
    target: Option<Target>,
    domain: Domain,
    panel: Panel,
    /// The bounds that the figures of every unseen subject must satisfy.
    bounds: Vec<Bound>,
    /// Steps of all phases.
    steps: u32,
}

impl Plan {
    /// Checks every part of a job.
    fn new(job: &Job) -> Result<Self, ForgeError> {
        let (profile, target, bounds) = match &job.target {
            None => {
                let profile = Profile::named(&job.profile)?;
                (profile, profile.target(), profile.bounds.to_vec())
            }
            Some(target) => {
                let profile = Profile::custom(&job.profile)?;
                // Refuses a name that a table cannot have before any work is done.
                Table::undisplaced(job.alpha, 1, &job.profile)?;
                (profile, Some(target.clone()), bounds_of_curve(target))
            }
        };
        let mut steps = job.steps.unwrap_or(profile.steps);
        ForgeError::unless_in_range("steps", steps, MAX_STEPS)?;
        if profile.recipe == Recipe::Undisplaced {
            steps = 0;
        }
        let most = target.as_ref().map_or(MAX_RADIUS, |_| MAX_RADIAL_RADIUS);
        ForgeError::unless_in_range("R", job.radius, most)?;
        let map = Map::new(job.alpha, job.radius).map_err(ForgeError::Table)?;
        let mut domain = Domain::new(map);
        if domain.twins.is_empty() || domain.scale() < MIN_SIDE {
            return Err(ForgeError::field(
                "alpha",
                format!("{} ({})", job.alpha, job.prospect()),
                "at least 1.1, and neither a fraction of small integers nor next to one: there the \
                          map has ties, or an order of thresholds that no periodic twin of moderate size has",
            ));
        }
        if let Recipe::Radial { .. } = profile.recipe {
            // Curves are followed on unbounded patterns.
            domain.twins.clear();
        }
        let panel = Panel::new(&domain.map, &domain.twins);
        Ok(Self {
            profile,
            panel: match &target {
                Some(target) => panel.with_target(target.clone(), &domain.map),
                None => panel,
            },
            bounds,
            job: job.clone(),
            target,
            domain,
            steps,
        })
    }

    /// The history of a table after `steps` steps, without figures.
    fn provenance(&self, steps: u32) -> Provenance {
        let (optimizer, mut parameters) = self.profile.recipe.describe();
        parameters.extend(self.target.iter().flat_map(to_parameters));
        if let Recipe::Radial { .. } = self.profile.recipe {
            let alphas = self.domain.spread().len();
            parameters.push(("alphas".into(), alphas.to_string()));
        }
        parameters.push(("jitter".into(), self.profile.jitter.to_string()));
        parameters.push(("steps".into(), self.steps.to_string()));
        if steps < self.steps {
            parameters.push(("stopped_after".into(), steps.to_string()));
        }
        Provenance {
            optimizer: optimizer.into(),
            parameters,
            seed: self.job.seed,
            twins: self.domain.twins.clone(),
            figures: Vec::new(),
        }
    }
}

impl Task for Job {
    type Plan = Plan;

    fn plan(&self) -> Result<Plan, ForgeError> {
        Plan::new(self)
    }
}

impl Work for Plan {
    type Table = Table;
    const AXES: usize = 2;

    fn identity(&self) -> String {
        let provenance = self.provenance(self.steps);
        let mut lines = vec![
            ("forge".into(), env!("CARGO_PKG_VERSION").into()),
            ("arithmetic".into(), ARITHMETIC.to_string()),
            ("points".into(), ALGORITHM_VERSION.to_string()),
            ("format".into(), FORMAT_VERSION.to_string()),
            ("profile".into(), self.job.profile.clone()),
            ("alpha".into(), self.job.alpha.to_string()),
            ("radius".into(), self.job.radius.to_string()),
            ("seed".into(), self.job.seed.to_string()),
            ("optimizer".into(), provenance.optimizer),
        ];
        lines.extend(provenance.parameters);
        let twins = provenance.twins.iter();
        lines.extend(twins.map(|twin| ("twin".into(), twin.to_string())));
        let line = |(name, value): (String, String)| format!("{name} = {value}\n");
        lines.into_iter().map(line).collect()
    }

    fn start(&self) -> State {
        let (blocks, reach) = (self.domain.blocks(), self.profile.jitter);
        State::start(jitter::<2>(blocks, reach, self.job.seed).into_flattened())
    }

    fn phases(&self) -> Vec<Box<dyn Phase + '_>> {
        let recipe = &self.profile.recipe;
        recipe.phases(&self.domain, self.target.as_ref(), self.steps)
    }

    fn table(
        &self,
        state: &State,
        [steps, _]: [u32; 2],
        figures: Vec<Figures>,
    ) -> Result<Table, ForgeError> {
        let unit = 1.0 / self.domain.scale();
        let allowed = "vectors short enough for a table, as after fewer steps";
        let too_long = || ForgeError::field("displacement", "too long", allowed);
        let vectors = vectors(&state.moves)
            .iter()
            .map(|[x, y]| Some([from_grid_units(x * unit)?, from_grid_units(y * unit)?]))
            .collect::<Option<Vec<_>>>()
            .ok_or_else(too_long)?;
        let history = Provenance {
            figures,
            ..self.provenance(steps)
        };
        let (map, name) = (self.domain.map.clone(), &self.job.profile);
        Ok(Table::new(map, name, vectors, history)?)
    }

    fn judging(&self) -> (u32, u64, Duration) {
        // Up to ν = 4, on two cores.
        let time = Duration::from_nanos(5000);
        (self.panel.subjects(), self.panel.points(), time)
    }

    fn measure(&self, table: &Table, meter: &mut Meter<'_>) -> Option<Vec<Figures>> {
        self.panel.measure(table, meter)
    }

    fn complaints(&self, figures: &[Figures]) -> Vec<Complaint> {
        complaints(&self.bounds, figures)
    }

    fn ranked(&self, table: Table) -> Result<Table, ForgeError> {
        // Without a least distance a thinned set would have another profile.
        match table.least_distance().is_useful() {
            true => with_ranks(&table),
            false => Ok(table),
        }
    }

    fn least_correlation(&self) -> Option<LeastCorrelation> {
        self.target.as_ref().map(LeastCorrelation::of)
    }
}

/// A job whose map has fewer intervals per axis carries a warning: of the 11 α with fewer in the scan of
/// `docs/alpha.md` no table is accepted, of the 23 others all but 3.
pub const FEW_INTERVALS: usize = 43;

/// The facts about a job's table that are known before it is made. They take about the time of making its map.
///
/// ```
/// use strew_forge::Job;
///
/// let job = |alpha: &str| Ok::<_, strew_core::Error>(Job::new(alpha.parse()?));
/// let good = job("(5-sqrt(3))/2")?.prospect();
/// assert_eq!((good.intervals, good.period), (63, None));
/// assert!(good.hopeless().is_none());
/// // The pattern of 3/2 repeats every 4 grid units and has one point there.
/// let bad = job("3/2")?.prospect();
/// assert_eq!((bad.intervals, bad.period), (1, Some(4)));
/// assert!(bad.hopeless().is_some());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Prospect {
    /// The intervals of the map per axis.
    pub intervals: usize,
    /// The period of the pattern along each axis in grid units, if α is a fraction.
    pub period: Option<u64>,
    /// Why no table can be good, if α is too small, or a fraction on which thresholds of the map coincide.
    why: Option<&'static str>,
    displaces: bool,
}

const NEAR_ONE: &str =
    "alpha is below 1.1, where points are so far apart in the grid that a map sees few";
const TIES: &str = "alpha is a fraction of small integers, so neighborhoods repeat and thresholds of the map coincide";

impl Prospect {
    /// The number of vectors of the table.
    pub const fn blocks(&self) -> usize {
        self.intervals * self.intervals
    }

    /// The reason why no such table can be good, if there is one. The forge then refuses the job.
    pub fn hopeless(&self) -> Option<String> {
        let why = self.why.filter(|_| self.displaces);
        why.map(|why| format!("{why} ({self})"))
    }

    /// The reason why the judge will probably reject the table, if there is one: the map has too few blocks.
    pub fn doubt(&self) -> Option<String> {
        let is_doubtful = self.displaces && self.intervals < FEW_INTERVALS;
        is_doubtful.then(|| {
            format!("no table with this few blocks has met the bounds of `blue` so far ({self})")
        })
    }
}

impl fmt::Display for Prospect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let blocks = match self.intervals {
            1 => "1 block".into(),
            n => format!("{n} × {n} blocks"),
        };
        f.write_str(&blocks)?;
        match self.period {
            Some(period) => write!(f, ", and the pattern repeats every {period} grid units"),
            None => Ok(()),
        }
    }
}

impl Job {
    /// The facts about the table that are known before the work.
    pub fn prospect(&self) -> Prospect {
        // A period of 49 to 121 points has a few tall peaks, wherever they are moved: the judge refused every table, and of 2601
        // points it accepted one (`docs/alpha.md`).
        const FEW: u64 = 16;
        let map = Map::new(self.alpha, self.radius).ok();
        let fraction = self.alpha.fraction();
        // The pattern has that number squared of points in a period, and intervals no more than that, whatever rounding adds.
        let units = fraction.map(|(p, q)| p - q);
        let is_small = units.is_some_and(|units| units < FEW);
        // Where thresholds coincide, their order holds at no other α, and not in a twin.
        let itself = fraction.and_then(|(p, q)| Twin::new(p, q));
        let has_ties = |map: &Map| itself.is_some_and(|twin| !map.has_twin(twin));
        let intervals = map.as_ref().map_or(0, Map::intervals);
        Prospect {
            intervals: units.map_or(intervals, |units| (intervals as u64).min(units) as usize),
            period: fraction.map(|(_, q)| q.saturating_mul(2)),
            why: match &map {
                _ if self.alpha.set_side_f64() < MIN_SIDE => Some(NEAR_ONE),
                Some(map) if is_small && has_ties(map) => Some(TIES),
                _ => None,
            },
            displaces: self.target.is_some() || self.profile != "pattern",
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;
    use crate::{Checkpoint, Progress, Watch, forge, resume};

    #[test]
    fn what_is_hopeless_is_refused_by_the_forge() {
        for (alpha, is_hopeless) in [
            ("3/2", true),
            ("4/3", true),
            ("1.05", true),
            ("7/4", true),
            ("sqrt(2)", false),
            ("183/112", false),
        ] {
            let job = Job {
                radius: 20,
                steps: Some(1),
                ..Job::new(alpha.parse().expect("valid"))
            };
            let prospect = job.prospect();
            assert_eq!(prospect.hopeless().is_some(), is_hopeless, "{alpha}");
            assert_eq!(forge(&job, &()).is_err(), is_hopeless, "{alpha}");
            let plain = Job {
                profile: "pattern".into(),
                ..job
            };
            assert!(plain.prospect().hopeless().is_none());
        }
    }

    #[test]
    fn a_state_without_whole_vectors_is_refused() {
        struct Keep(Mutex<Option<Checkpoint>>);
        impl Watch for Keep {
            fn progress(&self, _: &Progress) {}

            fn checkpoint(&self, checkpoint: &Checkpoint) {
                *self.0.lock().expect("alone") = Some(checkpoint.clone());
            }
        }
        let mut job = Job::new("sqrt(3)".parse().expect("valid"));
        (job.radius, job.steps) = (9, Some(2));
        let keep = Keep(Mutex::default());
        forge(&job, &keep).expect("valid");
        let mut kept = keep.0.into_inner().expect("alone").expect("one");
        kept.state.moves.pop();
        let error = resume(&job, kept, &()).expect_err("refused").to_string();
        assert!(error.contains("of another state"), "{error}");
    }
}
