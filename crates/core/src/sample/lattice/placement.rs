//! The parameters that lay a table's points into the world.

use super::{Keep, Spacing};
use crate::sample::{Seed, Warp};

/// Spacing, seed, warp and share. With a table's digest, the first three make a point a pure function
/// of its lattice address; the share decides which points exist.
///
/// ```
/// use strew_core::{Placement, Seed, Spacing, Warp};
///
/// let placement = Placement::new(Spacing::new(2.0)?, Seed(7));
/// assert_eq!(placement.warp, Warp::ON);
/// assert_eq!(placement.with_warp(Warp::OFF).warp, Warp::OFF);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The mean spacing, in world units.
    pub spacing: Spacing,
    /// The seed.
    pub seed: Seed,
    /// The strength of the warp.
    pub warp: Warp,
    /// The share of the points that is kept.
    pub keep: Keep,
}

impl Placement {
    /// The default for a seed: all points, without warp for seed 0 and with [`Warp::ON`] for every
    /// other.
    #[must_use]
    pub const fn new(spacing: Spacing, seed: Seed) -> Self {
        Self {
            spacing,
            seed,
            warp: Self::default_warp(seed),
            keep: Keep::ALL,
        }
    }

    /// The warp of a seed by default.
    #[must_use]
    pub const fn default_warp(seed: Seed) -> Warp {
        if seed.0 == 0 { Warp::OFF } else { Warp::ON }
    }

    /// This placement with another share.
    #[must_use]
    pub const fn with_keep(self, keep: Keep) -> Self {
        Self { keep, ..self }
    }

    /// This placement with another warp.
    #[must_use]
    pub const fn with_warp(self, warp: Warp) -> Self {
        Self { warp, ..self }
    }
}
