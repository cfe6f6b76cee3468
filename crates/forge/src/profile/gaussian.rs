//! Profiles made by Gaussian repulsion: `blue` and `sharp`.

use super::{Phase, Profile, Recipe, named};
use crate::{
    energy::{Gaussian, Guard},
    ground::Ground,
    judge::{Bound, Figure},
    optimize::{Descent, Pairs},
};

/// Gaussian repulsion, with a guard against close pairs, in two phases; lengths in mean spacings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianRecipe {
    /// Width of the Gaussian in the first phase.
    pub sigma: f64,
    /// Its width in the second phase. A wider Gaussian goes on lowering the low frequencies and
    /// leaves the rest as it is; the first phase alone, run until the low frequencies are as low,
    /// also sharpens the set and raises its spectral peak.
    pub polish_sigma: f64,
    /// The second phase's share of the steps.
    pub polish_share: f64,
    /// Pairs closer than this are pushed apart besides: the smallest distance ends a little below.
    pub guard_reach: f64,
    /// How hard.
    pub guard_strength: f64,
    /// Spacings moved per unit of gradient.
    pub rate: f64,
}

/// Gaussian blue noise of σ = 1: the least low-frequency power.
pub(super) const BLUE: Profile = Profile {
    name: "blue",
    summary: "Gaussian blue noise, sigma 1: least power at low frequencies",
    recipe: Recipe::Gaussian(GaussianRecipe {
        sigma: 1.0,
        polish_sigma: 1.15,
        polish_share: 0.52,
        guard_reach: 0.72,
        guard_strength: 0.3,
        rate: 0.2,
    }),
    jitter: 0.7,
    steps: 250,
    bounds: &[
        Bound::at_most(Figure::LowPower, 2e-5),
        Bound::at_most(Figure::PeakPower, 3.0),
        Bound::at_least(Figure::DeltaMin, 0.6),
    ],
};

/// Gaussian blue noise of σ = 0.8: as crisp as capacity-constrained optimal transport (BNOT).
///
/// Target: a spectrum empty up to a steep rise at ν ≈ 0.93, and cells of nearly equal areas.
pub(super) const SHARP: Profile = Profile {
    name: "sharp",
    summary: "Gaussian blue noise, sigma 0.8: a steep edge, cells of nearly equal areas",
    recipe: Recipe::Gaussian(GaussianRecipe {
        sigma: 0.8,
        polish_sigma: 1.0,
        polish_share: 0.16,
        guard_reach: 0.9,
        guard_strength: 0.3,
        rate: 0.1,
    }),
    jitter: 0.7,
    steps: 640,
    bounds: &[
        Bound::at_least(Figure::NuEff, 0.93),
        Bound::at_most(Figure::LowPower, 5e-5),
        Bound::at_least(Figure::DeltaMin, 0.8),
        Bound::at_most(Figure::AreaDeviation, 0.1),
    ],
};

impl GaussianRecipe {
    pub(super) fn phases(&self, ground: &Ground, steps: u32) -> Vec<Phase> {
        let polish = (f64::from(steps) * self.polish_share) as u32;
        let phase = |sigma, steps| {
            let guard = Guard::new(self.guard_reach, self.guard_strength);
            let energy = (Gaussian::new(sigma), guard);
            Phase {
                objective: Box::new(Pairs::new(energy, &ground.maps(), ground.scale())),
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

    pub(super) fn describe(&self) -> Vec<(String, String)> {
        named(&[
            ("sigma", self.sigma),
            ("polish_sigma", self.polish_sigma),
            ("polish_share", self.polish_share),
            ("guard_reach", self.guard_reach),
            ("guard_strength", self.guard_strength),
            ("rate", self.rate),
        ])
    }
}
