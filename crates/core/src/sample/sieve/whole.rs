//! The sieve of a whole plan.

use alloc::sync::Arc;

use super::LocalSieve;
use crate::{
    sample::{lattice::Lattice, near::Mask},
    shape::Area,
    table::FRACTION_BITS,
};

/// The conditions on every point of a plan.
#[derive(Clone, Debug)]
pub(crate) struct Sieve {
    /// Its area is `None` where all of the plan's box is requested.
    mask: Mask,
    /// The set, if its points are left out by their kind one by one.
    picked: Option<Arc<Lattice>>,
    /// The least and the greatest distance of a point from its lattice address, in lattice units, by
    /// axis.
    reach: [[f64; 2]; 2],
    /// World units per lattice unit.
    unit: f64,
}

impl Sieve {
    /// A sieve, or `None` if everything passes. `reach` has the least and the greatest distance of a point
    /// from its lattice address by axis, in fixed-point units.
    pub(crate) fn new(lattice: &Lattice, mask: Mask, reach: [[i32; 2]; 2]) -> Option<Self> {
        let picked = lattice.picks().then(|| Arc::new(lattice.clone()));
        if mask.area.is_none() && mask.clear.is_empty() && picked.is_none() {
            return None;
        }
        let grid_units = |v: i32| f64::from(v) / f64::from(1u32 << FRACTION_BITS);
        Some(Self {
            mask,
            picked,
            reach: reach.map(|reach| reach.map(grid_units)),
            unit: lattice.step * f64::from(1u32 << FRACTION_BITS),
        })
    }

    /// A sieve to be aimed at one piece of the lattice after another.
    pub(crate) fn local(&self) -> LocalSieve {
        let tests = (self.mask.clear_guards(), self.picked.clone());
        LocalSieve::new(tests, self.reach, self.unit)
    }

    /// Whether there are other sets to keep clear of.
    pub(crate) fn is_guarded(&self) -> bool {
        !self.mask.clear.is_empty()
    }

    /// The conditions on the places of points.
    pub(crate) const fn mask(&self) -> &Mask {
        &self.mask
    }

    /// The area in which points lie, if not in all of the box.
    pub(crate) const fn area(&self) -> Option<&Area> {
        self.mask.area.as_ref()
    }
}
