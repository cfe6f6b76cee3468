//! The blue-noise profiles `blue`, `sharp`, `spaced` and `lloyd`.

use super::{Profile, Push, Recipe, Repulsion};
use crate::judge::{Bound, Figure};

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
