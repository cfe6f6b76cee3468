//! A checked job: its profile, the domain it is optimized on, and the panel it is judged on.

use std::time::Duration;

use strew_core::{
    ALGORITHM_VERSION, Map, Table,
    table::{FORMAT_VERSION, Figures, Provenance, from_grid_units},
};

use crate::{
    ForgeError, Job, MAX_RADIUS, MAX_STEPS,
    curve::{LeastCorrelation, Target, to_parameters},
    forge::{Task, Work},
    judge::{Bound, Complaint, Panel, bounds_of_curve, complaints},
    optimize::{DescentState, jitter},
    phase::Phase,
    profile::{Profile, Recipe},
    ranks::with_ranks,
    twins::Domain,
    watch::Meter,
};

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
    type State = DescentState;
    type Table = Table;

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

    fn start(&self) -> DescentState {
        let (blocks, reach) = (self.domain.blocks(), self.profile.jitter);
        DescentState::start(jitter(blocks, reach, self.job.seed))
    }

    fn phases(&self) -> Vec<Box<dyn Phase<DescentState> + '_>> {
        let recipe = &self.profile.recipe;
        recipe.phases(&self.domain, self.target.as_ref(), self.steps)
    }

    fn table(
        &self,
        state: &DescentState,
        [steps, _]: [u32; 2],
        figures: Vec<Figures>,
    ) -> Result<Table, ForgeError> {
        let unit = 1.0 / self.domain.scale();
        let too_long = || {
            ForgeError::field(
                "displacement",
                "too long",
                "vectors short enough for a table, as after fewer steps",
            )
        };
        let moves = state.moves.iter();
        let vectors = moves
            .map(|m| Some([from_grid_units(m[0] * unit)?, from_grid_units(m[1] * unit)?]))
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
