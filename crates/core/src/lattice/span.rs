//! Spans: a region along one axis, in lattice terms.

use core::ops::Range;

use super::Lattice;
use crate::{
    pattern::Axis,
    table::{FRACTION_BITS, fixed},
    warp::Shears,
};

/// One axis of a region.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Span {
    /// The fixed-point coordinates inside the region.
    pub(crate) bounds: Range<i128>,
    /// The lattice coordinates whose points may lie inside.
    pub(crate) all: Range<i64>,
    /// The lattice coordinates whose points lie inside whatever their displacement and warp; at the end
    /// of `all` if there are none.
    pub(crate) inner: Range<i64>,
    /// The least and the greatest distance of a point of `all` from its lattice address, in fixed-point
    /// units.
    pub(crate) reach: [i32; 2],
}

impl Span {
    /// The spans along x and y of the points between fixed-point bounds on both axes. There are none if
    /// the bounds of an axis are empty.
    pub(crate) fn of_box(lattice: &Lattice, bounds: [Range<i128>; 2]) -> [Self; 2] {
        let is_empty = bounds.iter().any(Range::is_empty);
        let table = reach_of(lattice);
        let into = match &lattice.shears {
            Some(shears) if !is_empty => added(table, shears.drift_into([&bounds[0], &bounds[1]])),
            _ => table,
        };
        let all = [0, 1].map(|i| match &bounds[i] {
            bounds if bounds.is_empty() => first(bounds.start)..first(bounds.start),
            bounds => reached(bounds, into[i]),
        });
        let reach = match &lattice.shears {
            Some(shears) if all.iter().all(|all| !all.is_empty()) => {
                reach_from(lattice, shears, &all)
            }
            _ => table,
        };
        [0, 1].map(|i| Self::new(bounds[i].clone(), all[i].clone(), reach[i]))
    }

    /// The parts of spans in some columns and rows, by the movement of the warp there.
    pub(crate) fn of_piece(
        lattice: &Lattice,
        spans: [&Self; 2],
        piece: [Range<i64>; 2],
    ) -> [Self; 2] {
        match &lattice.shears {
            Some(shears) if !piece.iter().any(Range::is_empty) => {
                let reach = reach_from(lattice, shears, &piece);
                [0, 1].map(|i| {
                    let bounds = spans[i].bounds.clone();
                    let all = overlap(&reached(&bounds, reach[i]), &piece[i]);
                    Self::new(bounds, all, reach[i])
                })
            }
            _ => [0, 1].map(|i| spans[i].within(&piece[i])),
        }
    }

    /// The span of the lattice coordinates in `all`, whose points are `reach` from their addresses.
    fn new(bounds: Range<i128>, all: Range<i64>, reach: [i32; 2]) -> Self {
        let [least, most] = reach.map(i128::from);
        let inner = first(bounds.start - least)..first(bounds.end - most);
        let inner = overlap(&inner, &all);
        Self {
            inner: if inner.is_empty() {
                all.end..all.end
            } else {
                inner
            },
            bounds,
            all,
            reach,
        }
    }

    /// The part of the span in a range of lattice coordinates.
    pub(crate) fn within(&self, range: &Range<i64>) -> Self {
        let (all, inner) = (overlap(&self.all, range), overlap(&self.inner, range));
        Self {
            bounds: self.bounds.clone(),
            inner: if inner.is_empty() {
                all.end..all.end
            } else {
                inner
            },
            all,
            reach: self.reach,
        }
    }

    /// The two parts of `all` outside `inner`.
    pub(crate) fn margins(&self) -> [Range<i64>; 2] {
        [
            self.all.start..self.inner.start,
            self.inner.end..self.all.end,
        ]
    }

    /// Whether the point of a lattice coordinate with a displacement lies inside. Ignores the warp.
    pub(crate) fn holds(&self, v: i64, displacement: i32) -> bool {
        self.bounds.contains(&(fixed(v) + i128::from(displacement)))
    }
}

/// The part of a range within another one; empty and within that if there is none.
fn overlap(part: &Range<i64>, whole: &Range<i64>) -> Range<i64> {
    let start = part.start.clamp(whole.start, whole.end);
    start..part.end.clamp(start, whole.end)
}

/// The first lattice coordinate at or above a fixed-point one.
const fn first(k: i128) -> i64 {
    -((-k) >> FRACTION_BITS) as i64
}

/// The lattice coordinates whose points, between two distances from their addresses, may lie in `bounds`.
fn reached(bounds: &Range<i128>, [least, most]: [i32; 2]) -> Range<i64> {
    first(bounds.start - i128::from(most))..first(bounds.end - i128::from(least))
}

fn reach_of(lattice: &Lattice) -> [[i32; 2]; 2] {
    [Axis::X, Axis::Y].map(|axis| lattice.table_reach(axis))
}

fn added(a: [[i32; 2]; 2], b: [[i32; 2]; 2]) -> [[i32; 2]; 2] {
    [0, 1].map(|i| [a[i][0] + b[i][0], a[i][1] + b[i][1]])
}

/// The box of the places of the points of some columns and rows, which are not empty, in fixed-point units.
pub(crate) fn places_of(lattice: &Lattice, lines: &[Range<i64>; 2]) -> [Range<i128>; 2] {
    let reach = match &lattice.shears {
        Some(shears) => reach_from(lattice, shears, lines),
        None => reach_of(lattice),
    };
    [0, 1].map(|i| {
        let [least, most] = reach[i].map(i128::from);
        fixed(lines[i].start) + least..fixed(lines[i].end - 1) + most + 1
    })
}

/// The least and the greatest distance of the points of some columns and rows from their addresses, by axis.
fn reach_from(lattice: &Lattice, shears: &Shears, lines: &[Range<i64>; 2]) -> [[i32; 2]; 2] {
    let table = reach_of(lattice);
    let displaced = [0, 1].map(|i| {
        let [least, most] = table[i].map(i128::from);
        [
            fixed(lines[i].start) + least,
            fixed(lines[i].end - 1) + most,
        ]
    });
    added(table, shears.drift_from(displaced))
}
