//! A checked job: its map, its twins, and the phases of its optimization.

use strew_core::{
    Map, Table,
    table::{Provenance, from_grid_units},
};

use crate::{
    ForgeError, Job, MAX_RADIUS, MAX_STEPS,
    ground::Ground,
    judge::Panel,
    optimize::jitter,
    profile::{Phase, Profile, Recipe},
};

/// The least side t of the set region (α = 1.1): below, a map of any half-width sees too few
/// neighbors, and there are too many grid points between them to list.
const LEAST_SIDE: f64 = 0.05;

/// A checked job.
pub(crate) struct Plan {
    pub(crate) profile: &'static Profile,
    ground: Ground,
    pub(crate) panel: Panel,
    pub(crate) steps: u32,
}

impl Plan {
    pub(crate) fn new(job: &Job) -> Result<Self, ForgeError> {
        let profile = Profile::named(&job.profile)?;
        let mut steps = job.steps.unwrap_or(profile.steps);
        in_range("steps", steps, MAX_STEPS)?;
        if profile.recipe == Recipe::Undisplaced {
            steps = 0;
        }
        in_range("R", job.radius, MAX_RADIUS)?;
        let map = Map::new(job.alpha, job.radius).map_err(|e| ForgeError::Table(e.into()))?;
        let ground = Ground::new(map);
        if ground.twins.is_empty() || ground.scale() < LEAST_SIDE {
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
            panel: Panel::new(&ground.map, &ground.twins),
            ground,
            steps,
        })
    }

    pub(crate) fn start(&self, seed: u64) -> Vec<[f64; 2]> {
        jitter(self.ground.blocks(), self.profile.jitter, seed)
    }

    pub(crate) fn phases(&self) -> Vec<Phase> {
        self.profile.recipe.phases(&self.ground, self.steps)
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
            twins: self.ground.twins.clone(),
            figures: Vec::new(),
        }
    }

    pub(crate) fn table(
        &self,
        moves: &[[f64; 2]],
        provenance: Provenance,
    ) -> Result<Table, ForgeError> {
        let unit = 1.0 / self.ground.scale();
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
        let table = Table::new(
            self.ground.map.clone(),
            self.profile.name,
            vectors,
            provenance,
        )?;
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
