//! Points before and after they settle, and boxes of them.

use alloc::vec::Vec;
use core::ops::Range;

use super::{freedom::local, step::WHOLE};
use crate::sample::{bounds::common_box, lattice::PointId};

/// A point where it has settled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settled {
    pub(crate) id: PointId,
    /// In fixed-point units.
    pub(crate) place: [i128; 2],
    /// The share at its place at full density.
    pub(crate) share: f64,
}

/// A box of places, in fixed-point units.
pub(crate) type Box2 = [Range<i128>; 2];

/// A point where its rank left it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub(crate) id: PointId,
    /// In fixed-point units.
    pub(crate) place: [i128; 2],
    pub(crate) share: f64,
    /// Fixed-point units of a mean spacing at full density, and the bits of a window's unit.
    scale: (f64, u32),
}

impl Placed {
    pub(super) const fn new(
        (id, place, share): (PointId, [i128; 2], f64),
        scale: (f64, u32),
    ) -> Self {
        Self {
            id,
            place,
            share,
            scale,
        }
    }

    /// The greatest move along each axis, in fixed-point units.
    fn most_move(&self) -> i64 {
        let (unit, shift) = self.scale;
        most_move(unit * local(self.share), shift)
    }

    /// Whether the point is in a box wherever it goes, in none of it, or either.
    pub(crate) fn side(&self, bounds: &Box2) -> Option<bool> {
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
pub(crate) fn widened([x, y]: &Box2, room: i64) -> Box2 {
    let room = i128::from(room);
    [x.start - room..x.end + room, y.start - room..y.end + room]
}

/// Adds a place to a box.
pub(crate) fn add_place(within: &mut Option<Box2>, place: [i128; 2]) {
    let own = place.map(|k| k..k + 1);
    *within = Some(match within.take() {
        Some(within) => hull(&within, &own),
        None => own,
    });
}

/// The box around two boxes.
fn hull(a: &Box2, b: &Box2) -> Box2 {
    [0, 1].map(|i| a[i].start.min(b[i].start)..a[i].end.max(b[i].end))
}

/// Joins boxes that overlap, and those where a common window is smaller than one for each, by the margin around a
/// window.
pub(crate) fn joined(boxes: impl Iterator<Item = Box2>, margin: i128) -> Vec<Box2> {
    let area = |within: &Box2| -> f64 {
        let sides = within
            .each_ref()
            .map(|range| range.end - range.start + 2 * margin);
        sides[0] as f64 * sides[1] as f64
    };
    let mut all: Vec<Box2> = Vec::new();
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
