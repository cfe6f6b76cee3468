//! A checked job: its profile, the domain it is optimized on, and the panel it is judged on.

use strew_core::{
    ALGORITHM_VERSION, Map, Table,
    table::{FORMAT_VERSION, Provenance, from_grid_units},
};

use crate::{
    ForgeError, Job, MAX_RADIUS, MAX_STEPS,
    curve::{LeastCorrelation, Target, to_parameters},
    judge::{Bound, Panel, bounds_of_curve},
    optimize::{Descent, jitter},
    profile::{Phase, Profile, Recipe},
    twins::Domain,
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
pub(crate) struct Plan {
    pub(crate) profile: &'static Profile,
    /// The name of the table's profile. For a custom curve it differs from that of `profile`.
    name: String,
    /// The radial power curve to follow, if any.
    target: Option<Target>,
    domain: Domain,
    pub(crate) panel: Panel,
    /// The bounds that the figures of every unseen subject must satisfy.
    pub(crate) bounds: Vec<Bound>,
    /// Steps of all phases.
    pub(crate) steps: u32,
}

impl Plan {
    /// Checks every part of a job.
    pub(crate) fn new(job: &Job) -> Result<Self, ForgeError> {
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
            name: job.profile.clone(),
            target,
            domain,
            steps,
        })
    }

    /// The random start for a seed.
    pub(crate) fn start(&self, seed: u64) -> Vec<[f64; 2]> {
        jitter(self.domain.blocks(), self.profile.jitter, seed)
    }

    /// The least pair correlation of a set with the curve, if there is a curve to follow.
    pub(crate) fn least_correlation(&self) -> Option<LeastCorrelation> {
        self.target.as_ref().map(LeastCorrelation::of)
    }

    /// The phases of the optimization.
    pub(crate) fn phases(&self) -> Vec<Phase> {
        self.profile
            .recipe
            .phases(&self.domain, self.target.as_ref(), self.steps)
    }

    /// The number of vectors.
    pub(crate) fn blocks(&self) -> usize {
        self.domain.blocks()
    }

    /// Everything that decides the result, as lines of `name = value`. Two jobs with equal lines
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

    /// The history of a table after `steps` steps, without figures.
    pub(crate) fn provenance(&self, job: &Job, steps: u32) -> Provenance {
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
            seed: job.seed,
            twins: self.domain.twins.clone(),
            figures: Vec::new(),
        }
    }

    /// The table with these vectors, which are in mean spacings.
    pub(crate) fn table(
        &self,
        moves: &[[f64; 2]],
        provenance: Provenance,
    ) -> Result<Table, ForgeError> {
        let unit = 1.0 / self.domain.scale();
        let too_long = || {
            ForgeError::field(
                "displacement",
                "too long",
                "vectors short enough for a table, as after fewer steps",
            )
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

#[cfg(test)]
mod tests {
    use strew_core::Alpha;

    use super::*;
    use crate::forge;

    fn of(alpha: &str) -> Alpha {
        alpha.parse().expect("valid")
    }

    #[test]
    fn bad_parts_are_refused_with_name_value_and_allowed_range() {
        let good = Job {
            radius: 15,
            steps: Some(1),
            ..Job::new("(5-sqrt(3))/2".parse().expect("valid"))
        };
        let bad: [(fn(&mut Job), _); 7] = [
            (|job| job.alpha = of("3/2"), ["alpha", "3/2", "1.1"]),
            (|job| job.alpha = of("1.01"), ["alpha", "101/100", "1.1"]),
            (|job| job.steps = Some(0), ["steps", "0", "1 to 1000000"]),
            (
                |job| job.steps = Some(u32::MAX),
                ["steps", "4294967295", "1000000"],
            ),
            (|job| job.radius = 0, ["R", "0", "1 to 256"]),
            (|job| job.radius = 257, ["R", "257", "1 to 256"]),
            (
                |job| job.profile = "bleu".into(),
                ["profile", "bleu", "blue"],
            ),
        ];
        for (change, words) in bad {
            let mut job = good.clone();
            change(&mut job);
            let refused = [
                forge(&job, &()).expect_err("refused"),
                job.estimate().expect_err("refused"),
            ];
            for error in refused.map(|e| e.to_string()) {
                assert!(words.iter().all(|word| error.contains(word)), "{error}");
            }
        }
    }
}
