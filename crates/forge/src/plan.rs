//! A checked job: what to optimize, on what, and in which phases.

use strew_core::{
    Map, Table, Twin,
    table::{Provenance, from_grid_units},
};

use crate::{
    ForgeError, Job,
    energy::{Gaussian, Guard},
    job::{MAX_RADIUS, MAX_STEPS},
    judge::Panel,
    optimize::{Descent, Objective, Pairs, Radial, Reach, jitter},
    profile::{GaussianRecipe, Profile, RadialRecipe, Recipe, Target},
    twins::{next_to_alpha, of_fraction},
};

/// How many twins a table is optimized on. They lie on both sides of α, so that among them they
/// show nearly every pair of blocks that any twin of the map has.
pub(crate) const TWINS: usize = 6;
/// Twins with fewer points repeat before a block's neighborhood ends.
const LEAST_TWIN: u64 = 4000;
/// The least side t of the set region (α = 1.1): below, a map of any half-width sees too few
/// neighbors, and there are too many grid points between them to list.
const LEAST_SIDE: f64 = 0.05;
/// The largest half-width for a radial power curve, whose pairs reach far: 1 GB of neighbor lists.
const MAX_RADIAL_RADIUS: u32 = 200;
/// Longer parameters of a history are split.
const PARAMETER_BYTES: usize = 800;

/// A checked job.
pub(crate) struct Plan {
    pub(crate) profile: &'static Profile,
    pub(crate) panel: Panel,
    pub(crate) steps: u32,
    /// The name of the table's profile.
    name: String,
    /// The curve to follow, for profiles that do.
    target: Option<Target>,
    map: Map,
    /// The twins it is optimized on; none if it is optimized on α itself.
    twins: Vec<Twin>,
}

/// Some steps with one energy.
pub(crate) struct Phase {
    pub(crate) objective: Box<dyn Objective>,
    pub(crate) descent: Descent,
}

impl Plan {
    pub(crate) fn new(job: &Job) -> Result<Self, ForgeError> {
        let (profile, target) = match &job.target {
            None => {
                let profile = Profile::named(&job.profile)?;
                (profile, profile.target())
            }
            Some(target) => (Profile::custom(&job.profile)?, Some(target.clone())),
        };
        let steps = job.steps.unwrap_or(profile.steps);
        in_range("steps", steps, MAX_STEPS)?;
        let most = target.as_ref().map_or(MAX_RADIUS, |_| MAX_RADIAL_RADIUS);
        in_range("R", job.radius, most)?;
        let map = Map::new(job.alpha, job.radius).map_err(|e| ForgeError::Table(e.into()))?;
        let mut twins: Vec<Twin> = next_to_alpha(&map)
            .filter(|twin| twin.is_uniform() && twin.points() >= LEAST_TWIN)
            .take(TWINS)
            .collect();
        if twins.is_empty() || map.alpha().set_side_f64() < LEAST_SIDE {
            return Err(ForgeError::Field {
                field: "alpha",
                value: job.alpha.to_string(),
                allowed: "at least 1.1, and not a fraction of small numbers, whose map has ties \
                          that no periodic twin has"
                    .into(),
            });
        }
        if let Recipe::Radial(_) = profile.recipe {
            twins.clear();
        }
        let panel = Panel::new(&map, &twins);
        Ok(Self {
            profile,
            panel: target.iter().cloned().fold(panel, Panel::with_target),
            name: job.profile.clone(),
            target,
            map,
            twins,
            steps,
        })
    }

    /// Mean spacings per grid unit.
    fn scale(&self) -> f64 {
        self.map.alpha().set_side_f64()
    }

    pub(crate) fn start(&self, seed: u64) -> Vec<[f64; 2]> {
        let blocks = self.map.intervals() * self.map.intervals();
        jitter(blocks, self.profile.jitter, seed)
    }

    pub(crate) fn phases(&self) -> Vec<Phase> {
        match (&self.profile.recipe, &self.target) {
            (Recipe::Gaussian(recipe), _) => {
                let polish = (f64::from(self.steps) * recipe.polish_share) as u32;
                let phases = [
                    (recipe.sigma, self.steps - polish),
                    (recipe.polish_sigma, polish),
                ];
                phases
                    .map(|(sigma, steps)| self.gaussian(recipe, sigma, steps))
                    .into()
            }
            (Recipe::Radial(recipe), Some(target)) => vec![self.radial(recipe, target)],
            (Recipe::Radial(_), None) => Vec::new(),
        }
    }

    fn gaussian(&self, recipe: &GaussianRecipe, sigma: f64, steps: u32) -> Phase {
        let guard = Guard::new(recipe.guard_reach, recipe.guard_strength);
        let energy = (Gaussian::new(sigma), guard);
        let maps: Vec<Map> = self
            .twins
            .iter()
            .filter_map(|&twin| of_fraction(&self.map, twin))
            .collect();
        Phase {
            objective: Box::new(Pairs::new(energy, &maps, self.scale())),
            descent: Descent {
                steps,
                rate: recipe.rate,
            },
        }
    }

    /// On the unbounded pattern of α: its pairs have exact frequencies too, and those that occur in
    /// twins alone are too few to show in a spectrum.
    fn radial(&self, recipe: &RadialRecipe, target: &Target) -> Phase {
        let reach = Reach(recipe.weights.reach);
        let pairs = Pairs::new(reach, std::slice::from_ref(&self.map), self.scale());
        Phase {
            objective: Box::new(Radial::new(pairs, target, &recipe.weights)),
            descent: Descent {
                steps: self.steps,
                rate: recipe.rate,
            },
        }
    }

    pub(crate) fn provenance(&self, job: &Job, steps: u32) -> Provenance {
        let (optimizer, mut parameters) = self.profile.recipe.describe();
        for (part, text) in self.target.iter().flat_map(in_parts).enumerate() {
            let name = match part {
                0 => "target".into(),
                more => format!("target_{}", more + 1),
            };
            parameters.push((name, text));
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
            twins: self.twins.clone(),
            figures: Vec::new(),
        }
    }

    pub(crate) fn table(
        &self,
        moves: &[[f64; 2]],
        provenance: Provenance,
    ) -> Result<Table, ForgeError> {
        let unit = 1.0 / self.scale();
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
        let table = Table::new(self.map.clone(), &self.name, vectors, provenance)?;
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

/// The points of a curve as text, `nu power` separated by semicolons, in parts of moderate length.
fn in_parts(target: &Target) -> Vec<String> {
    let mut parts = vec![String::new()];
    for [nu, power] in target.points() {
        let point = format!("{nu} {power}");
        match parts.last_mut() {
            Some(part) if part.is_empty() => part.push_str(&point),
            Some(part) if part.len() + point.len() < PARAMETER_BYTES => {
                part.push_str("; ");
                part.push_str(&point);
            }
            _ => parts.push(point),
        }
    }
    parts
}
