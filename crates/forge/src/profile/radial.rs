//! Profiles that follow a radial power curve.

use std::slice;

use super::{Phase, Profile, Recipe, named};
use crate::{
    curve::Target,
    energy::Gaussian,
    ground::Ground,
    judge::{Bound, Figure},
    optimize::{Descent, Objective, Pairs, Radial, RadialWeights},
};

/// Parameters of [`Recipe::Radial`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialRecipe {
    /// The points (ν, power) of the curve; see [`Target`].
    pub curve: &'static [[f64; 2]],
    /// What its error costs.
    pub weights: RadialWeights,
    /// The share of the steps that Gaussian repulsion (σ = 1) takes before: it empties the low
    /// frequencies fast, for curves that are 0 nearly as far as that reaches.
    pub warm_share: f64,
    /// Spacings moved per unit of gradient, at first.
    pub rate: f64,
}

impl RadialRecipe {
    /// The parameters but the curve, for a table's history.
    pub(super) fn describe(&self) -> Vec<(String, String)> {
        let weights = &self.weights;
        let mut parameters = vec![
            ("reach", weights.reach),
            ("nu_max", weights.nu_max),
            ("fit", weights.fit),
            ("quiet", weights.quiet),
            ("edge", weights.edge),
            ("leash", weights.leash),
            ("rate", self.rate),
        ];
        if self.warm_share > 0.0 {
            parameters.push(("warm_share", self.warm_share));
        }
        named(&parameters)
    }

    /// All steps, on unbounded patterns: that of α, whose pairs have exact frequencies too, and for
    /// the curve also those of other α of the same map, so that it holds on every twin.
    pub(super) fn phases(&self, ground: &Ground, target: &Target, steps: u32) -> Vec<Phase> {
        let warm = (self.warm_share * f64::from(steps)) as u32;
        let map = slice::from_ref(&ground.map);
        let repulsion: Box<dyn Objective> =
            Box::new(Pairs::new(Gaussian::new(1.0), map, ground.scale()));
        let curve: Box<dyn Objective> =
            Box::new(Radial::new(&ground.spread(), target, &self.weights));
        let phase = |objective, steps, rate| Phase {
            objective,
            descent: Descent { steps, rate },
        };
        let phases = [
            phase(repulsion, warm, WARM_RATE),
            phase(curve, steps - warm, self.rate),
        ];
        let some = phases.into_iter().filter(|phase| phase.descent.steps > 0);
        some.collect()
    }
}

/// Spacings moved per unit of gradient of the repulsion.
const WARM_RATE: f64 = 0.2;

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
        warm_share: 0.0,
        rate: 0.1,
    }),
    jitter: 0.7,
    steps: 250,
    bounds: &[
        Bound::at_most(Figure::QuietPower, 5e-4),
        Bound::at_most(Figure::TailWorst, 0.05),
        Bound::at_most(Figure::TargetRms, 0.03),
    ],
};

/// Power rises from nothing to a broad peak at ν = 0.62: the tone of the middle frequencies. Unlike
/// most sets of that name it is also silent below.
pub(super) const GREEN: Profile = Profile {
    name: "green",
    summary: "Green noise: silent up to nu 0.42, a broad peak at 0.62, flat from 0.9 on",
    recipe: Recipe::Radial(RadialRecipe {
        curve: &[[0.0, 0.0], [0.42, 0.0], [0.62, 3.0], [0.9, 1.0]],
        weights: RadialWeights {
            quiet: 0.8,
            ..WEIGHTS
        },
        warm_share: 0.0,
        rate: 0.05,
    }),
    jitter: 0.7,
    steps: 200,
    bounds: &[
        Bound::at_most(Figure::QuietPower, 0.01),
        Bound::at_least(Figure::PeakPower, 2.5),
        Bound::at_least(Figure::PeakNu, 0.5),
        Bound::at_most(Figure::PeakNu, 0.75),
        Bound::at_most(Figure::TailWorst, 0.1),
    ],
};

/// Power falls as 1/ν, from 5.5 at ν = 0.127 to 1 at 0.7: clusters of all sizes.
pub(super) const PINK: Profile = Profile {
    name: "pink",
    summary: "Pink noise: power falls as 1/nu from 5.5 at nu 0.127 to 1 at nu 0.7, flat beyond",
    recipe: Recipe::Radial(RadialRecipe {
        curve: &[
            [0.1, 5.5],
            [0.1273, 5.5],
            [0.145, 4.8276],
            [0.16, 4.375],
            [0.18, 3.8889],
            [0.2, 3.5],
            [0.225, 3.1111],
            [0.25, 2.8],
            [0.28, 2.5],
            [0.31, 2.2581],
            [0.35, 2.0],
            [0.4, 1.75],
            [0.45, 1.5556],
            [0.5, 1.4],
            [0.56, 1.25],
            [0.63, 1.1111],
            [0.7, 1.0],
        ],
        weights: RadialWeights {
            leash: 3.0,
            ..WEIGHTS
        },
        warm_share: 0.0,
        rate: 0.05,
    }),
    jitter: 0.7,
    steps: 250,
    bounds: &[
        Bound::at_most(Figure::TargetRelative, 0.1),
        Bound::at_most(Figure::TailWorst, 0.1),
    ],
};

/// No power up to ν = 0.67, one peak, a shallow dip, flat from 1.9 on: quiet farther out than a step
/// can be, without the oscillations of sharper sets. The curve is one that sets can have: drawn
/// steeper, it is missed by 0.1, or power comes back at low frequencies.
pub(super) const SINGLE_PEAK: Profile = Profile {
    name: "single-peak",
    summary: "Single-peak blue noise: no power up to nu 0.67, one peak, a shallow dip, flat from nu 1.9 on",
    recipe: Recipe::Radial(RadialRecipe {
        curve: &[
            [0.0, 0.0],
            [0.668, 0.0],
            [0.708, 0.04],
            [0.749, 0.16],
            [0.789, 0.38],
            [0.83, 0.7],
            [0.87, 1.09],
            [0.911, 1.48],
            [0.951, 1.82],
            [0.992, 2.02],
            [1.032, 2.07],
            [1.073, 1.97],
            [1.113, 1.77],
            [1.154, 1.5],
            [1.194, 1.21],
            [1.235, 0.98],
            [1.275, 0.84],
            [1.316, 0.77],
            [1.356, 0.75],
            [1.417, 0.78],
            [1.518, 0.86],
            [1.619, 0.9],
            [1.72, 0.93],
            [1.822, 0.96],
            [1.9, 1.0],
        ],
        weights: RadialWeights {
            quiet: 1.5,
            ..WEIGHTS
        },
        warm_share: 0.3,
        rate: 0.05,
    }),
    jitter: 0.7,
    steps: 400,
    bounds: &[
        Bound::at_most(Figure::LowPower, 1e-3),
        Bound::at_least(Figure::NuEff, 0.81),
        Bound::at_most(Figure::TargetRms, 0.035),
    ],
};

/// A curve that somebody drew: judged by how near it came, within the
/// [bounds](crate::judge::bounds_of_curve) that the curve itself gives.
pub(super) const CUSTOM: Profile = Profile {
    name: "custom",
    summary: "A radial power curve of your own",
    recipe: Recipe::Radial(RadialRecipe {
        curve: &[],
        weights: WEIGHTS,
        warm_share: 0.0,
        rate: 0.1,
    }),
    jitter: 0.7,
    steps: 250,
    bounds: &[],
};
