//! A checked job: its map, its twins, and the phases of its optimization.

use strew_core::{
    Map, Table, Twin,
    table::{Provenance, from_grid_units},
};

use crate::{
    ForgeError, Job, MAX_RADIUS, MAX_STEPS,
    energy::{Gaussian, Guard, PairEnergy},
    judge::Panel,
    optimize::{Descent, Pairs, jitter},
    profile::{GaussianRecipe, Profile, Recipe},
    twins::{next_to_alpha, of_fraction},
};

/// How many twins a table is optimized on. They lie on both sides of α, so that among them they
/// show nearly every pair of blocks that any twin of the map has.
const TWINS: usize = 6;
/// Twins with fewer points repeat before a block's neighborhood ends.
const LEAST_TWIN: u64 = 4000;
/// The least side t of the set region (α = 1.1): below, a map of any half-width sees too few
/// neighbors, and there are too many grid points between them to list.
const LEAST_SIDE: f64 = 0.05;

/// A checked job.
pub(crate) struct Plan {
    pub(crate) profile: &'static Profile,
    map: Map,
    twins: Vec<Twin>,
    pub(crate) panel: Panel,
    pub(crate) steps: u32,
}

/// Some steps with one energy.
pub(crate) struct Phase<E> {
    pub(crate) objective: Pairs<E>,
    pub(crate) descent: Descent,
}

impl Plan {
    pub(crate) fn new(job: &Job) -> Result<Self, ForgeError> {
        let profile = Profile::named(&job.profile)?;
        let steps = job.steps.unwrap_or(profile.steps);
        in_range("steps", steps, MAX_STEPS)?;
        in_range("R", job.radius, MAX_RADIUS)?;
        let map = Map::new(job.alpha, job.radius).map_err(|e| ForgeError::Table(e.into()))?;
        let twins: Vec<Twin> = next_to_alpha(&map)
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
        Ok(Self {
            profile,
            panel: Panel::new(&map, &twins),
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

    pub(crate) fn phases(&self) -> Vec<Phase<impl PairEnergy + use<>>> {
        let Recipe::Gaussian(recipe) = self.profile.recipe;
        let polish = (f64::from(self.steps) * recipe.polish_share) as u32;
        [
            (recipe.sigma, self.steps - polish),
            (recipe.polish_sigma, polish),
        ]
        .map(|(sigma, steps)| self.phase(&recipe, sigma, steps))
        .into()
    }

    fn phase(
        &self,
        recipe: &GaussianRecipe,
        sigma: f64,
        steps: u32,
    ) -> Phase<impl PairEnergy + use<>> {
        let guard = Guard::new(recipe.guard_reach, recipe.guard_strength);
        let energy = (Gaussian::new(sigma), guard);
        let maps: Vec<Map> = self
            .twins
            .iter()
            .filter_map(|&twin| of_fraction(&self.map, twin))
            .collect();
        Phase {
            objective: Pairs::new(energy, &maps, self.scale()),
            descent: Descent {
                steps,
                rate: recipe.rate,
            },
        }
    }

    pub(crate) fn provenance(&self, job: &Job, steps: u32) -> Provenance {
        let (optimizer, mut parameters) = self.profile.recipe.describe();
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
        let table = Table::new(self.map.clone(), self.profile.name, vectors, provenance)?;
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
