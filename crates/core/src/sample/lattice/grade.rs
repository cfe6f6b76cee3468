//! A field, as a lattice follows it.

use alloc::sync::Arc;
use core::fmt;

use crate::sample::{area::Region, field::Field};

/// The relative change of the share across a local spacing at which half of a move is left. On the table
/// `blue` with 129 intervals, in a Gaussian of 67 spacings, δ_min is 0.05 without damping, 0.10 at 0.1, 0.21 at
/// 0.05, 0.33 at 0.03 and 0.34 at 0.02, where the mean distance falls.
const STEEP: f64 = 0.03;

/// The shares of a field, times the share of the set.
#[derive(Clone)]
pub(crate) struct Grade {
    field: Arc<dyn Field>,
    factor: f64,
}

impl fmt::Debug for Grade {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut all = f.debug_struct("Grade");
        all.field("factor", &self.factor).finish_non_exhaustive()
    }
}

impl Grade {
    pub(super) fn new(field: Arc<dyn Field>, factor: f64) -> Self {
        Self { field, factor }
    }

    /// The field with another factor.
    pub(super) fn times(&self, factor: f64) -> Self {
        Self::new(self.field.clone(), factor)
    }

    /// The share at a place, within [0, 1].
    pub(crate) fn share(&self, at: [f64; 2]) -> f64 {
        self.limited(self.field.share(at))
    }

    /// The shares at some places.
    pub(crate) fn shares(&self, places: &[[f64; 2]], shares: &mut [f64]) {
        self.field.shares(places, shares);
        for share in shares {
            *share = self.limited(*share);
        }
    }

    /// Bounds of the shares over a box.
    pub(crate) fn bounds(&self, within: &Region) -> [f64; 2] {
        self.field.bounds(within).map(|share| self.limited(share))
    }

    /// A share of the field within [0, 1], times the factor. NaN becomes 0.
    #[inline(always)]
    fn limited(&self, share: f64) -> f64 {
        if share > 0.0 {
            share.min(1.0) * self.factor
        } else {
            0.0
        }
    }
}

/// The places around a place that tell how steep a field is there, half a local spacing away.
#[inline(always)]
pub(crate) fn around([x, y]: [f64; 2], share: f64, spacing: f64) -> [[f64; 2]; 4] {
    let half = 0.5 * spacing / square_root(share);
    [[x - half, y], [x + half, y], [x, y - half], [x, y + half]]
}

/// The square root, which rounds alike everywhere.
#[inline(always)]
fn square_root(v: f64) -> f64 {
    #[cfg(feature = "std")]
    return v.sqrt();
    #[cfg(not(feature = "std"))]
    libm::sqrt(v)
}

/// The part of a move that is left, by the shares [`around`] a place: less where the field is steep. Where the
/// share changes much within a local spacing, a point's neighbors have other shares, and have not moved
/// as the ladder expects.
#[inline(always)]
pub(crate) fn damping([left, right, below, above]: [f64; 4]) -> f64 {
    let x = 2.0 * (right - left) / (left + right);
    let y = 2.0 * (above - below) / (below + above);
    1.0 / (1.0 + (x * x + y * y) / (STEEP * STEEP))
}
