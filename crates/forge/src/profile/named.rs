//! The named profiles: blue noise, and those that follow a radial power curve.

use super::{Following, Profile, Push, Recipe, Repulsion};
use crate::{
    judge::{Bound, Figure},
    optimize::RadialWeights,
};

/// Gaussian blue noise of σ = 1: the least power at low frequencies.
pub(super) const BLUE: Profile = Profile {
    name: "blue",
    summary: "Gaussian blue noise, sigma 1: least power at low frequencies",
    recipe: Recipe::Gaussian(Repulsion {
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
/// Goal: no power below a steep rise at ν ≈ 0.93, and Voronoi cells of nearly equal areas.
pub(super) const SHARP: Profile = Profile {
    name: "sharp",
    summary: "Gaussian blue noise, sigma 0.8: a steep edge, cells of nearly equal areas",
    recipe: Recipe::Gaussian(Repulsion {
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

/// A large minimum distance, like farthest-point optimization (FPO), with low power and small
/// holes.
///
/// Goal: δ_min ≥ 0.93 of the hexagonal distance. The first stage makes ordinary blue noise. With a
/// hard push from the start, conflicts would freeze before holes close.
pub(super) const SPACED: Profile = Profile {
    name: "spaced",
    summary: "large minimum distance, small holes",
    recipe: Recipe::Spacing {
        sigma: 1.0,
        pushes: &[
            Push {
                reach: 0.9,
                strength: 0.3,
                rate: 0.2,
                share: 0.07,
            },
            Push {
                reach: 1.02,
                strength: 20.0,
                rate: 0.01,
                share: 0.465,
            },
            Push {
                reach: 1.015,
                strength: 200.0,
                rate: 0.001,
                share: 0.465,
            },
        ],
    },
    jitter: 0.7,
    steps: 860,
    bounds: &[
        Bound::at_least(Figure::DeltaMin, 0.93),
        Bound::at_most(Figure::LowPower, 1.5e-2),
        Bound::at_most(Figure::LargestHole, 0.85),
    ],
};

/// Points at the centroids of their Voronoi cells.
///
/// Goal: the least mean squared distance from a place to its nearest point. The descent starts from
/// the pattern itself, so the seed has no effect, and converges with the help of momentum.
pub(super) const LLOYD: Profile = Profile {
    name: "lloyd",
    summary: "centroidal Voronoi relaxation of the pattern, at convergence",
    recipe: Recipe::Lloyd { rate: 0.5 },
    jitter: 0.0,
    steps: 400,
    bounds: &[
        Bound::at_least(Figure::DeltaMin, 0.7),
        Bound::at_most(Figure::AreaDeviation, 0.3),
        Bound::at_most(Figure::LargestHole, 0.8),
    ],
};

/// Values that suit most curves.
const FOLLOWING: Following = Following {
    curve: "",
    weights: WEIGHTS,
    warm_share: 0.0,
    rate: 0.1,
};
const WEIGHTS: RadialWeights = RadialWeights {
    reach: 18.0,
    nu_max: 5.0,
    fit: 1.0,
    quiet: 0.2,
    edge: 0.1,
    leash: 2.5,
};

/// No power up to ν₀ = 0.56 and the power of a random set beyond. The largest possible ν₀ of a step
/// is 1/√π = 0.5642, where the pair correlation at distance 0 reaches 0; for a larger ν₀ it would
/// have to be negative.
pub(super) const STEP: Profile = Profile {
    name: "step",
    summary: "Step blue noise: no power up to nu 0.56, flat beyond",
    recipe: Recipe::Radial(Following {
        curve: "0 0; 0.56 0; 0.56 1",
        ..FOLLOWING
    }),
    bounds: &[
        Bound::at_most(Figure::QuietPower, 5e-4),
        Bound::at_most(Figure::TailWorst, 0.05),
        Bound::at_most(Figure::TargetRms, 0.03),
    ],
    ..CUSTOM
};

/// Power rises from 0 to a broad peak at ν = 0.62, in the middle frequencies. Unlike most sets
/// called green noise, this one has no power below ν = 0.42.
pub(super) const GREEN: Profile = Profile {
    name: "green",
    summary: "Green noise: silent up to nu 0.42, a broad peak at 0.62, flat from 0.9 on",
    recipe: Recipe::Radial(Following {
        curve: "0 0; 0.42 0; 0.62 3; 0.9 1",
        weights: RadialWeights {
            quiet: 0.8,
            ..WEIGHTS
        },
        rate: 0.05,
        ..FOLLOWING
    }),
    steps: 200,
    bounds: &[
        Bound::at_most(Figure::QuietPower, 0.01),
        Bound::at_least(Figure::PeakPower, 2.5),
        Bound::at_least(Figure::PeakNu, 0.5),
        Bound::at_most(Figure::PeakNu, 0.75),
        Bound::at_most(Figure::TailWorst, 0.1),
    ],
    ..CUSTOM
};

/// Power falls as 1/ν from 5.5 at ν = 0.127 to 1 at ν = 0.7: clusters of all sizes.
pub(super) const PINK: Profile = Profile {
    name: "pink",
    summary: "Pink noise: power falls as 1/nu from 5.5 at nu 0.127 to 1 at nu 0.7, flat beyond",
    recipe: Recipe::Radial(Following {
        curve: "0.1 5.5; 0.1273 5.5; 0.145 4.8276; 0.16 4.375; 0.18 3.8889; 0.2 3.5; 0.225 3.1111; \
                0.25 2.8; 0.28 2.5; 0.31 2.2581; 0.35 2; 0.4 1.75; 0.45 1.5556; 0.5 1.4; 0.56 1.25; \
                0.63 1.1111; 0.7 1",
        weights: RadialWeights {
            leash: 3.0,
            ..WEIGHTS
        },
        rate: 0.05,
        ..FOLLOWING
    }),
    bounds: &[
        Bound::at_most(Figure::TargetRelative, 0.1),
        Bound::at_most(Figure::TailWorst, 0.1),
    ],
    ..CUSTOM
};

/// No power up to ν = 0.67, one peak, a shallow dip, flat from ν = 1.9 on: quiet farther out than a
/// step can be, without the oscillations of sharper sets. A steeper rise cannot be reached: either
/// the error grows to 0.1, or power returns at low frequencies.
pub(super) const SINGLE_PEAK: Profile = Profile {
    name: "single-peak",
    summary: "Single-peak blue noise: no power up to nu 0.67, one peak, a shallow dip, flat from nu 1.9 on",
    recipe: Recipe::Radial(Following {
        curve: "0 0; 0.668 0; 0.708 0.04; 0.749 0.16; 0.789 0.38; 0.83 0.7; 0.87 1.09; 0.911 1.48; \
                0.951 1.82; 0.992 2.02; 1.032 2.07; 1.073 1.97; 1.113 1.77; 1.154 1.5; 1.194 1.21; \
                1.235 0.98; 1.275 0.84; 1.316 0.77; 1.356 0.75; 1.417 0.78; 1.518 0.86; 1.619 0.9; \
                1.72 0.93; 1.822 0.96; 1.9 1",
        weights: RadialWeights {
            quiet: 1.5,
            ..WEIGHTS
        },
        warm_share: 0.3,
        rate: 0.05,
    }),
    steps: 400,
    bounds: &[
        Bound::at_most(Figure::LowPower, 1e-3),
        Bound::at_least(Figure::NuEff, 0.81),
        Bound::at_most(Figure::TargetRms, 0.035),
    ],
    ..CUSTOM
};

/// A custom curve, whose [bounds](crate::judge::bounds_of_curve) follow from the curve itself.
pub(super) const CUSTOM: Profile = Profile {
    name: "custom",
    summary: "A custom radial power curve",
    recipe: Recipe::Radial(FOLLOWING),
    jitter: 0.7,
    steps: 250,
    bounds: &[],
};
