//! A field, as a lattice follows it.

use alloc::sync::Arc;
use core::fmt;

use crate::sample::{area::Region, field::Field};

/// The shares of a field, times the share of the set.
#[derive(Clone)]
pub(crate) struct Grade {
    field: Arc<dyn Field>,
    factor: f64,
    is_constant: bool,
}

impl fmt::Debug for Grade {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut all = f.debug_struct("Grade");
        all.field("factor", &self.factor).finish_non_exhaustive()
    }
}

/// A share of 1 everywhere.
struct Everywhere;

impl Field for Everywhere {
    fn share(&self, _: [f64; 2]) -> f64 {
        1.0
    }

    fn bounds(&self, _: &Region) -> [f64; 2] {
        [1.0; 2]
    }

    fn slopes(&self, _: &Region) -> [f64; 2] {
        [0.0; 2]
    }
}

impl Grade {
    /// The same share everywhere.
    pub(crate) fn constant(share: f64) -> Self {
        Self {
            field: Arc::new(Everywhere),
            factor: share,
            is_constant: true,
        }
    }

    pub(crate) fn new(field: Arc<dyn Field>, factor: f64) -> Self {
        Self {
            field,
            factor,
            is_constant: false,
        }
    }

    /// The field with another factor.
    pub(crate) fn times(&self, factor: f64) -> Self {
        Self::new(self.field.clone(), factor)
    }

    /// The share, if it is no field's.
    pub(crate) fn known(&self) -> Option<f64> {
        self.is_constant.then_some(self.factor)
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

    /// Bounds of the change of the shares along x and y for each world unit, over a box.
    pub(crate) fn slopes(&self, within: &Region) -> [f64; 2] {
        self.field.slopes(within).map(|slope| slope * self.factor)
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
