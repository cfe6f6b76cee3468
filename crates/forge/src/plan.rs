//! A checked job: its map, its twins, and the phases of its optimization.

use strew_core::{
    ALGORITHM_VERSION, Map, Table,
    table::{FORMAT_VERSION, Provenance, from_grid_units},
};

use crate::{
    ForgeError, Job, MAX_RADIUS, MAX_STEPS,
    curve::{LeastCorrelation, Target, to_parameters},
    domain::Domain,
    judge::{Bound, Panel, bounds_of_curve},
    optimize::{Descent, jitter},
    profile::{Phase, Profile, Recipe},
};

/// The least side t of the set region (α = 1.1): below, a map of any half-width sees too few
/// neighbors, and there are too many grid points between them to list.
const LEAST_SIDE: f64 = 0.05;

/// The largest half-width for a radial power curve, whose pairs reach far: 1 to 2 GB of neighbor lists.
const MAX_RADIAL_RADIUS: u32 = 200;
/// To be raised with any change of what a step computes, down to the last bit: work that was begun
/// before must not go on after.
const ARITHMETIC: u32 = 2;

/// A checked job.
pub(crate) struct Plan {
    pub(crate) profile: &'static Profile,
    /// The name of the table's profile.
    name: String,
    /// The curve to follow, for profiles that do.
    target: Option<Target>,
    domain: Domain,
    pub(crate) panel: Panel,
    /// What every unseen subject must satisfy.
    pub(crate) bounds: Vec<Bound>,
    pub(crate) steps: u32,
}

impl Plan {
    pub(crate) fn new(job: &Job) -> Result<Self, ForgeError> {
        let (profile, target, bounds) = match &job.target {
            None => {
                let profile = Profile::named(&job.profile)?;
                (profile, profile.target(), profile.bounds.to_vec())
            }
            Some(target) => {
                let profile = Profile::custom(&job.profile)?;
                // A table must be able to bear the name: better known now than at the end.
                Table::undisplaced(job.alpha, 1, &job.profile)?;
                (profile, Some(target.clone()), bounds_of_curve(target))
            }
        };
        let mut steps = job.steps.unwrap_or(profile.steps);
        in_range("steps", steps, MAX_STEPS)?;
        if profile.recipe == Recipe::Undisplaced {
            steps = 0;
        }
        let most = target.as_ref().map_or(MAX_RADIUS, |_| MAX_RADIAL_RADIUS);
        in_range("R", job.radius, most)?;
        let map = Map::new(job.alpha, job.radius).map_err(|e| ForgeError::Table(e.into()))?;
        let mut domain = Domain::new(map);
        if domain.twins.is_empty() || domain.scale() < LEAST_SIDE {
            return Err(ForgeError::Field {
                field: "alpha",
                value: job.alpha.to_string(),
                allowed: "at least 1.1, and not a fraction of small numbers, whose map has ties \
                          that no periodic twin has"
                    .into(),
            });
        }
        if let Recipe::Radial(_) = profile.recipe {
            // It is optimized on unbounded patterns.
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
            name: job.profile.clone(),
            target,
            domain,
            steps,
        })
    }

    pub(crate) fn start(&self, seed: u64) -> Vec<[f64; 2]> {
        jitter(self.domain.blocks(), self.profile.jitter, seed)
    }

    /// Where the pair correlation of the curve is least, if there is a curve to follow.
    pub(crate) fn least_correlation(&self) -> Option<LeastCorrelation> {
        self.target.as_ref().map(LeastCorrelation::of)
    }

    pub(crate) fn phases(&self) -> Vec<Phase> {
        self.profile
            .recipe
            .phases(&self.domain, self.target.as_ref(), self.steps)
    }

    /// How many vectors there are.
    pub(crate) fn blocks(&self) -> usize {
        self.domain.blocks()
    }

    /// Everything that decides the result, as lines of `name = value`: two jobs whose lines agree
    /// take the same steps.
    pub(crate) fn identity(&self, job: &Job, phases: &[Phase]) -> String {
        let provenance = self.provenance(job, self.steps);
        let mut lines = vec![
            ("forge".into(), env!("CARGO_PKG_VERSION").into()),
            ("arithmetic".into(), ARITHMETIC.to_string()),
            ("points".into(), ALGORITHM_VERSION.to_string()),
            ("format".into(), FORMAT_VERSION.to_string()),
            ("profile".into(), self.name.clone()),
            ("alpha".into(), job.alpha.to_string()),
            ("radius".into(), job.radius.to_string()),
            ("seed".into(), job.seed.to_string()),
            ("optimizer".into(), provenance.optimizer),
        ];
        lines.extend(provenance.parameters);
        let twins = provenance.twins.iter();
        lines.extend(twins.map(|twin| ("twin".into(), twin.to_string())));
        let phases = phases.iter().map(|phase| {
            let Descent { steps, rate } = phase.descent;
            ("phase".into(), format!("{steps} steps at rate {rate}"))
        });
        lines.extend(phases);
        let line = |(name, value): (String, String)| format!("{name} = {value}\n");
        lines.into_iter().map(line).collect()
    }

    pub(crate) fn provenance(&self, job: &Job, steps: u32) -> Provenance {
        let (optimizer, mut parameters) = self.profile.recipe.describe();
        parameters.extend(self.target.iter().flat_map(to_parameters));
        if let Recipe::Radial(_) = self.profile.recipe {
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
            seed: job.seed,
            twins: self.domain.twins.clone(),
            figures: Vec::new(),
        }
    }

    pub(crate) fn table(
        &self,
        moves: &[[f64; 2]],
        provenance: Provenance,
    ) -> Result<Table, ForgeError> {
        let unit = 1.0 / self.domain.scale();
        let too_long = || ForgeError::Field {
            field: "displacement",
            value: "too long".into(),
            allowed: "vectors that a table can hold; a smaller start or fewer steps".into(),
        };
        let vectors = moves
            .iter()
            .map(|m| Some([from_grid_units(m[0] * unit)?, from_grid_units(m[1] * unit)?]))
            .collect::<Option<Vec<_>>>()
            .ok_or_else(too_long)?;
        let table = Table::new(self.domain.map.clone(), &self.name, vectors, provenance)?;
        Ok(table)
    }
}

fn in_range(field: &'static str, value: u32, most: u32) -> Result<(), ForgeError> {
    if (1..=most).contains(&value) {
        return Ok(());
    }
    Err(ForgeError::Field {
        field,
        value: value.to_string(),
        allowed: format!("1 to {most}"),
    })
}
