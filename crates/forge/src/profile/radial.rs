//! Profiles that follow a radial power curve.

use std::slice;

use super::{Phase, Profile, Recipe, Target, named};
use crate::{
    ground::Ground,
    judge::{Bound, Figure},
    optimize::{Descent, Pairs, Radial, RadialWeights, Reach},
};

/// Parameters of [`Recipe::Radial`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialRecipe {
    /// The points (ν, power) of the curve; see [`Target`](super::Target).
    pub curve: &'static [[f64; 2]],
    /// What its error costs.
    pub weights: RadialWeights,
    /// Spacings moved per unit of gradient, at first.
    pub rate: f64,
}

impl RadialRecipe {
    /// The parameters but the curve, for a table's history.
    pub(super) fn describe(&self) -> Vec<(String, String)> {
        let weights = &self.weights;
        named(&[
            ("reach", weights.reach),
            ("nu_max", weights.nu_max),
            ("fit", weights.fit),
            ("quiet", weights.quiet),
            ("edge", weights.edge),
            ("leash", weights.leash),
            ("rate", self.rate),
        ])
    }

    /// All steps, on the unbounded pattern of α: its pairs have exact frequencies too, and those
    /// that occur in twins alone are too few to show in a spectrum.
    pub(super) fn phase(&self, ground: &Ground, target: &Target, steps: u32) -> Phase {
        let reach = Reach(self.weights.reach);
        let pairs = Pairs::new(reach, slice::from_ref(&ground.map), ground.scale());
        Phase {
            objective: Box::new(Radial::new(pairs, target, &self.weights)),
            descent: Descent {
                steps,
                rate: self.rate,
            },
        }
    }
}

/// What serves every curve.
const WEIGHTS: RadialWeights = RadialWeights {
    reach: 18.0,
    nu_max: 5.0,
    fit: 1.0,
    quiet: 0.2,
    edge: 0.1,
    leash: 2.5,
};

/// No power up to ν₀ = 0.56, all of a random set's beyond. A step is possible up to
/// ν₀ = 1/√π = 0.5642 at most: there two points never coincide, and beyond, the number of close
/// pairs would have to be negative.
pub(super) const STEP: Profile = Profile {
    name: "step",
    summary: "Step blue noise: no power up to nu 0.56, flat beyond",
    recipe: Recipe::Radial(RadialRecipe {
        curve: &[[0.0, 0.0], [0.56, 0.0], [0.56, 1.0]],
        weights: WEIGHTS,
        rate: 0.1,
    }),
    jitter: 0.7,
    steps: 250,
    bounds: &[
        Bound::at_most(Figure::QuietPower, 2e-4),
        Bound::at_most(Figure::TailWorst, 0.05),
        Bound::at_most(Figure::TargetRms, 0.03),
    ],
};

/// A curve that somebody drew: judged by how near it came.
pub(super) const CUSTOM: Profile = Profile {
    name: "custom",
    summary: "A radial power curve of your own",
    recipe: Recipe::Radial(RadialRecipe {
        curve: &[],
        weights: WEIGHTS,
        rate: 0.1,
    }),
    jitter: 0.7,
    steps: 250,
    bounds: &[
        Bound::at_most(Figure::TargetRms, 0.1),
        Bound::at_most(Figure::TargetWorst, 0.5),
    ],
};
