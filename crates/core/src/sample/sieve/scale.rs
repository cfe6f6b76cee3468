//! The scale of a patch: reported coordinates of positions relative to its origin.

use crate::{
    sample::lattice::{Lattice, Patch},
    table::fixed,
};

/// Converts positions relative to a patch's origin into the coordinates that
/// [`Lattice::world`] reports.
#[derive(Clone, Copy)]
pub(crate) struct Scale {
    base: [f64; 2],
    step: f64,
}

impl Scale {
    pub(crate) fn new(lattice: &Lattice, patch: &Patch) -> Self {
        Self::at(lattice, patch.origin())
    }

    /// The scale of the patch at an origin.
    pub(crate) fn at(lattice: &Lattice, origin: [i64; 2]) -> Self {
        Self {
            base: origin.map(|v| fixed(v) as f64),
            step: lattice.step,
        }
    }

    /// The sum is exact in `f64` while lattice coordinates stay below 2⁵³ units, so it rounds as the
    /// conversion of the whole integer does.
    #[inline(always)]
    pub(crate) fn world(self, position: [i32; 2]) -> [f64; 2] {
        [
            (self.base[0] + f64::from(position[0])) * self.step,
            (self.base[1] + f64::from(position[1])) * self.step,
        ]
    }
}
