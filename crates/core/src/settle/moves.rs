//! Points before and after they settle, boxes of them, and how far they may move, without moving them.

use alloc::vec::Vec;
use core::{array::from_fn, ops::Range};

use super::{MOST_MOVE, freedom::local, step::WHOLE};
use crate::{
    lattice::{
        Grade,
        bounds::{common_box, world},
    },
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

/// A point where it has settled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settled<const D: usize = 2> {
    pub(crate) address: [i64; D],
    /// In fixed-point units.
    pub(crate) place: [i128; D],
    /// The share at its place at full density.
    pub(crate) share: f64,
}

/// A box of places of the plane, in fixed-point units.
pub(crate) type Box2 = [Range<i128>; 2];

/// A point where its rank left it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed<const D: usize = 2> {
    pub(crate) address: [i64; D],
    /// In fixed-point units.
    pub(crate) place: [i128; D],
    pub(crate) share: f64,
    /// Fixed-point units of a mean spacing at full density, and the bits of a window's unit.
    scale: (f64, u32),
}

impl<const D: usize> Placed<D> {
    pub(super) const fn new(
        (address, place, share): ([i64; D], [i128; D], f64),
        scale: (f64, u32),
    ) -> Self {
        Self {
            address,
            place,
            share,
            scale,
        }
    }

    /// The greatest move along each axis, in fixed-point units.
    fn most_move(&self) -> i64 {
        let (unit, shift) = self.scale;
        most_move(unit * local::<D>(self.share), shift)
    }

    /// Whether the point is in a box wherever it goes, in none of it, or either.
    pub(crate) fn side(&self, bounds: &[Range<i128>; D]) -> Option<bool> {
        let most = i128::from(self.most_move());
        let mut is_sure = true;
        for (range, place) in bounds.iter().zip(self.place) {
            if place + most < range.start || place - most >= range.end {
                return Some(false);
            }
            is_sure &= range.start <= place - most && place + most < range.end;
        }
        is_sure.then_some(true)
    }
}

/// The greatest move along each axis of points with a local spacing, all in fixed-point units, and the bits of a
/// window's unit.
pub(super) fn most_move(spacing: f64, shift: u32) -> i64 {
    // With room for what rounds.
    (f64::from(WHOLE) * 1.000_01 * spacing) as i64 + (2 << shift)
}

/// A box with some room on all sides.
pub(crate) fn widened<const D: usize>(within: &[Range<i128>; D], room: i64) -> [Range<i128>; D] {
    let room = i128::from(room);
    (within.each_ref()).map(|range| range.start - room..range.end + room)
}

/// Adds a place to a box.
pub(crate) fn add_place<const D: usize>(within: &mut Option<[Range<i128>; D]>, place: [i128; D]) {
    let own = place.map(|k| k..k + 1);
    *within = Some(match within.take() {
        Some(within) => hull(&within, &own),
        None => own,
    });
}

/// The box around two boxes.
fn hull<const D: usize>(a: &[Range<i128>; D], b: &[Range<i128>; D]) -> [Range<i128>; D] {
    from_fn(|i| a[i].start.min(b[i].start)..a[i].end.max(b[i].end))
}

/// Joins boxes that overlap, and those where a common window is smaller than one for each, by the margin around a
/// window.
pub(crate) fn joined<const D: usize>(
    boxes: impl Iterator<Item = [Range<i128>; D]>,
    margin: i128,
) -> Vec<[Range<i128>; D]> {
    let area = |within: &[Range<i128>; D]| -> f64 {
        let sides = within
            .each_ref()
            .map(|range| range.end - range.start + 2 * margin);
        sides.iter().map(|side| *side as f64).product()
    };
    let mut all: Vec<[Range<i128>; D]> = Vec::new();
    for mut next in boxes {
        while let Some(i) = all.iter().position(|other| {
            let overlaps = !common_box(other, &next).iter().any(Range::is_empty);
            overlaps || area(&hull(other, &next)) <= area(other) + area(&next)
        }) {
            next = hull(&all.swap_remove(i), &next);
        }
        all.push(next);
    }
    all
}
