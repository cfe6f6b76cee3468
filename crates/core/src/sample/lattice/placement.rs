//! The parameters that lay a table's points into the world, and the share of them that is kept.

use super::{Keep, Settle, Spacing};
use crate::sample::{Seed, Warp};

/// Spacing, seed, warp and share. With a table's digest, the first three make a point a pure function
/// of its lattice address; the share decides which points exist.
///
/// ```
/// use strew_core::{Keep, Placement, Seed, Settle, Spacing, Warp};
///
/// let placement = Placement::new(Spacing::new(2.0)?, Seed(7));
/// assert_eq!(placement.warp, Warp::ON);
/// assert_eq!(placement.with_warp(Warp::OFF).warp, Placement::default_warp(Seed(0)));
/// let far = placement.with_keep(Keep::new(0.5)?).with_lod(Keep::new(0.1)?).with_settle(Settle::OFF);
/// assert_eq!((far.keep.get(), far.lod.get(), far.settle.steps()), (0.5, 0.1, 0));
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
    /// How points settle.
    pub settle: Settle,
    /// The level of detail: the part of the points that is left out of nothing but the answer, so that none of the
    /// others move.
    pub lod: Keep,
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
            settle: Settle::TWO,
            lod: Keep::ALL,
        }
    }

    /// The default warp of a seed: off for seed 0, [`Warp::ON`] for every other.
    #[must_use]
    pub const fn default_warp(seed: Seed) -> Warp {
        if seed.0 == 0 { Warp::OFF } else { Warp::ON }
    }

    /// This placement with another share.
    #[must_use]
    pub const fn with_keep(self, keep: Keep) -> Self {
        Self { keep, ..self }
    }

    /// This placement with another number of steps by which points settle.
    #[must_use]
    pub const fn with_settle(self, settle: Settle) -> Self {
        Self { settle, ..self }
    }

    /// This placement with another level of detail.
    #[must_use]
    pub const fn with_lod(self, lod: Keep) -> Self {
        Self { lod, ..self }
    }

    /// The share of points that are kept and in the level of detail.
    pub(crate) const fn shown(&self) -> f64 {
        self.keep.get() * self.lod.get()
    }

    /// The share that multiplies those of a field. Where points settle, the level of detail is a choice among settled ones.
    pub(crate) const fn graded(&self) -> f64 {
        if self.settle.is_off() {
            self.shown()
        } else {
            self.keep.get()
        }
    }

    /// This placement with another warp.
    #[must_use]
    pub const fn with_warp(self, warp: Warp) -> Self {
        Self { warp, ..self }
    }
}
