//! How far points may move, without moving them.

use core::ops::Range;

use super::{
    MOST_MOVE,
    boxes::{most_move, widened},
    freedom::local,
};
use crate::{
    sample::{bounds::world, lattice::Grade},
    shape::Region,
    table::FRACTION_BITS,
};

/// The unit of a window in fixed-point units, in bits, where the pattern is not very sparse: some 10⁻⁵ spacings.
const UNIT_BITS: u32 = 7;

/// How far the points of a set that a grade thins may move.
#[derive(Clone, Debug)]
pub(crate) struct Moves<const D: usize> {
    pub(super) grade: Grade<D>,
    /// Windows count in units of this many fixed-point units, in bits.
    pub(super) shift: u32,
    /// Fixed-point units of a mean spacing at full density.
    pub(super) unit: f64,
    /// A fixed-point unit in world units.
    step: f64,
}

impl<const D: usize> Moves<D> {
    /// Those of a set whose mean spacing at full density is 1/`side` grid units.
    pub(crate) fn new(grade: Grade<D>, side: f64, step: f64) -> Self {
        // Up to some 350 spacings fit a window.
        let mut sparse = 0;
        while 400.0 / side > f64::from(1u32 << sparse) * 1500.0 {
            sparse += 1;
        }
        Self {
            grade,
            shift: UNIT_BITS + sparse,
            unit: f64::from(1u32 << FRACTION_BITS) / side,
            step,
        }
    }

    /// The greatest move of points that were placed in a box, in fixed-point units.
    pub(crate) fn most(&self, within: &[Range<i128>; D]) -> i64 {
        let low = self.grade.bounds(&self.region(within))[0];
        most_move(self.unit * local::<D>(low), self.shift)
    }

    /// The box around a box that holds the places of all points that may settle in it.
    pub(crate) fn around(&self, within: &[Range<i128>; D]) -> [Range<i128>; D] {
        let most = (MOST_MOVE * 1.001 * self.unit) as i64 + (2 << self.shift);
        let most = self.most(&widened(within, most)).min(most);
        widened(within, most)
    }

    /// The greatest share in a box.
    pub(crate) fn greatest_share(&self, within: &[Range<i128>; D]) -> f64 {
        self.grade.bounds(&self.region(within))[1]
    }

    /// The region of a box.
    pub(crate) fn region(&self, within: &[Range<i128>; D]) -> Region<D> {
        let world = |k: i128| world(self.step, k);
        let ends = within.each_ref();
        Region::between(
            ends.map(|range| world(range.start)),
            ends.map(|range| world(range.end.max(range.start))),
        )
    }
}
