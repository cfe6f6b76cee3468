//! Gaussian repulsion, which makes the tables of the profiles `blue` and `sharp`.

use super::Phase;
use crate::{
    domain::Domain,
    energy::{Gaussian, Guard},
    optimize::{Descent, Pairs},
};

/// Gaussian repulsion with a [`Guard`] against close pairs, in two phases. Lengths are in mean
/// spacings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianRecipe {
    /// The width of the Gaussian in the first phase.
    pub sigma: f64,
    /// The width of the Gaussian in the second phase. A wider Gaussian goes on lowering the power
    /// at low frequencies and leaves the rest as it is. The first phase alone, run until the power
    /// there is as low, also sharpens the set and raises its spectral peak.
    pub polish_sigma: f64,
    /// The share of the steps that the second phase takes.
    pub polish_share: f64,
    /// The range of the guard. The smallest distance ends a little below it.
    pub guard_reach: f64,
    /// The height of the guard at distance 0; see [`Guard::new`].
    pub guard_strength: f64,
    /// Mean spacings moved per unit of gradient.
    pub rate: f64,
}

impl GaussianRecipe {
    pub(crate) fn phases(&self, domain: &Domain, steps: u32) -> Vec<Phase> {
        let polish = (f64::from(steps) * self.polish_share) as u32;
        let phase = |sigma, steps| {
            let guard = Guard::new(self.guard_reach, self.guard_strength);
            let energy = (Gaussian::new(sigma), guard);
            Phase {
                objective: Box::new(Pairs::new(energy, &domain.twin_maps(), domain.scale())),
                descent: Descent {
                    steps,
                    rate: self.rate,
                },
            }
        };
        vec![
            phase(self.sigma, steps - polish),
            phase(self.polish_sigma, polish),
        ]
    }

    pub(crate) fn parameters(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("sigma", self.sigma),
            ("polish_sigma", self.polish_sigma),
            ("polish_share", self.polish_share),
            ("guard_reach", self.guard_reach),
            ("guard_strength", self.guard_strength),
            ("rate", self.rate),
        ]
    }
}
