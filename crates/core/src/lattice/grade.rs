//! A field, as a lattice follows it.

use alloc::sync::Arc;
use core::fmt;

use crate::{field::Field, parts::FIELDS, shape::Region};

/// The shares of a field, times the share of the set.
#[derive(Clone)]
pub(crate) struct Grade<const D: usize = 2> {
    /// `None` for the same share everywhere.
    field: Option<Arc<dyn Field<D>>>,
    factor: f64,
}

impl<const D: usize> fmt::Debug for Grade<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut all = f.debug_struct("Grade");
        all.field("factor", &self.factor).finish_non_exhaustive()
    }
}

impl<const D: usize> Grade<D> {
    /// The same share everywhere.
    pub(crate) const fn constant(share: f64) -> Self {
        Self {
            field: None,
            factor: share,
        }
    }

    pub(crate) fn new(field: Arc<dyn Field<D>>, factor: f64) -> Self {
        Self {
            field: Some(field),
            factor,
        }
    }

    /// The field with another factor.
    pub(crate) fn times(&self, factor: f64) -> Self {
        Self {
            field: self.field.clone(),
            factor,
        }
    }

    /// Whether it has the same shares for the same reason.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        alike(&self.field, &other.field, Arc::ptr_eq) && self.factor == other.factor
    }

    /// The field, if there is one.
    fn field(&self) -> Option<&dyn Field<D>> {
        self.field.as_deref().filter(|_| FIELDS)
    }

    /// The share, if it is no field's.
    pub(crate) fn known(&self) -> Option<f64> {
        self.field().is_none().then_some(self.factor)
    }

    /// The share at a place, within [0, 1].
    pub(crate) fn share(&self, at: [f64; D]) -> f64 {
        self.field()
            .map_or(self.factor, |field| self.limited(field.share(at)))
    }

    /// The shares at some places.
    pub(crate) fn shares(&self, places: &[[f64; D]], shares: &mut [f64]) {
        let Some(field) = self.field() else {
            return shares.fill(self.factor);
        };
        field.shares(places, shares);
        for share in shares {
            *share = self.limited(*share);
        }
    }

    /// Bounds of the shares over a box.
    pub(crate) fn bounds(&self, within: &Region<D>) -> [f64; 2] {
        let Some(field) = self.field() else {
            return [self.factor; 2];
        };
        field.bounds(within).map(|share| self.limited(share))
    }

    /// Bounds of the change of the shares along each axis for each world unit, over a box.
    pub(crate) fn slopes(&self, within: &Region<D>) -> [f64; D] {
        let slopes = self.field().map_or([0.0; D], |field| field.slopes(within));
        slopes.map(|slope| slope * self.factor)
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

/// Whether both are there and the same, or neither is.
pub(crate) fn alike<T>(a: &Option<T>, b: &Option<T>, same: impl Fn(&T, &T) -> bool) -> bool {
    a.as_ref()
        .zip(b.as_ref())
        .map_or(a.is_none() && b.is_none(), |(a, b)| same(a, b))
}
