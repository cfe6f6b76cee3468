//! How a table's points are laid into the world.

use super::{Seed, Spacing, Warp};

/// Spacing, seed and warp: with a table's digest, what makes a point a pure function of its
/// lattice address.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The mean spacing, in world units.
    pub spacing: Spacing,
    /// Which set of points.
    pub seed: Seed,
    /// How strongly the plane is warped.
    pub warp: Warp,
}

impl Placement {
    /// The default for a seed: seed 0 is the plain pattern, every other seed is warped.
    #[must_use]
    pub const fn new(spacing: Spacing, seed: Seed) -> Self {
        let warp = if seed.0 == 0 { Warp::OFF } else { Warp::ON };
        Self {
            spacing,
            seed,
            warp,
        }
    }

    /// The same with another warp.
    #[must_use]
    pub const fn with_warp(self, warp: Warp) -> Self {
        Self { warp, ..self }
    }
}
