//! How a table's points are laid into the world.

use super::{Seed, Spacing, Warp};

/// Which share of the points is kept: those whose [rank](super::rank) is below it. All by default.
///
/// A smaller share keeps some of the points of a larger one, wherever they are asked for.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Keep(f64);

/// A share that is not allowed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the share to keep is {0}; it must be a number from {min:e} to 1", min = Keep::MIN)]
pub struct KeepError(pub f64);

impl Keep {
    /// Everything.
    pub const ALL: Self = Self(1.0);
    /// The least share. Rows are looked at whether or not they keep points, so a smaller share would
    /// cost more than a wider spacing.
    pub const MIN: f64 = 1e-6;

    /// A share of the points.
    ///
    /// # Errors
    /// [`KeepError`] outside [`MIN`](Self::MIN) to 1 or for NaN.
    pub fn new(share: f64) -> Result<Self, KeepError> {
        if (Self::MIN..=1.0).contains(&share) {
            Ok(Self(share))
        } else {
            Err(KeepError(share))
        }
    }

    /// The share.
    #[must_use]
    pub const fn get(self) -> f64 {
        self.0
    }
}

impl Default for Keep {
    fn default() -> Self {
        Self::ALL
    }
}

/// Spacing, seed and warp: with a table's digest, what makes a point a pure function of its
/// lattice address; and which of the points there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The mean spacing, in world units.
    pub spacing: Spacing,
    /// Which set of points.
    pub seed: Seed,
    /// How strongly the plane is warped.
    pub warp: Warp,
    /// Which share of the points is kept.
    pub keep: Keep,
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
            keep: Keep::ALL,
        }
    }

    /// The same with a share of the points.
    #[must_use]
    pub const fn with_keep(self, keep: Keep) -> Self {
        Self { keep, ..self }
    }

    /// The same with another warp.
    #[must_use]
    pub const fn with_warp(self, warp: Warp) -> Self {
        Self { warp, ..self }
    }
}
