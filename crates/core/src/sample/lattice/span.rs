//! Spans: a region along one axis, in lattice terms.

use core::ops::Range;

use super::Lattice;
use crate::{
    pattern::Axis,
    table::{FRACTION_BITS, fixed},
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
    /// The spans along x and y of the box min ≤ p < max, for bounds within the lattice's limit.
    pub(crate) fn of_box(lattice: &Lattice, min: [f64; 2], max: [f64; 2]) -> [Self; 2] {
        let axes = [Axis::X, Axis::Y];
        let table = axes.map(|axis| lattice.table_reach(axis));
        let bounds = [0, 1].map(|i| {
            let [start, end] = [min, max].map(|corner| lattice.first_at_or_above(corner[i]));
            start..end
        });
        let is_empty = bounds.iter().any(Range::is_empty);
        let shears = lattice.shears.as_ref().filter(|_| !is_empty);
        let added = |a: [[i32; 2]; 2], b: [[i32; 2]; 2]| -> [[i32; 2]; 2] {
            [0, 1].map(|i| [a[i][0] + b[i][0], a[i][1] + b[i][1]])
        };
        let into = shears.map_or(table, |shears| {
            added(table, shears.drift_into([&bounds[0], &bounds[1]]))
        });
        // The first lattice coordinate at or above a fixed-point one.
        let first = |k: i128| -((-k) >> FRACTION_BITS) as i64;
        let all = [0, 1].map(|i| {
            let [least, most] = into[i].map(i128::from);
            let Range { start, end } = bounds[i].clone();
            if start == end {
                first(start)..first(start)
            } else {
                first(start - most)..first(end - least)
            }
        });
        let reach = match shears {
            Some(shears) if all.iter().all(|all| !all.is_empty()) => {
                let displaced = [0, 1].map(|i| {
                    let [least, most] = table[i].map(i128::from);
                    [fixed(all[i].start) + least, fixed(all[i].end - 1) + most]
                });
                added(table, shears.drift_from(displaced))
            }
            _ => table,
        };
        [0, 1].map(|i| {
            let [least, most] = reach[i].map(i128::from);
            let all = all[i].clone();
            let inner = first(bounds[i].start - least)..first(bounds[i].end - most);
            let inner = if inner.is_empty() || all.is_empty() {
                all.end..all.end
            } else {
                inner
            };
            Self {
                bounds: bounds[i].clone(),
                all,
                inner,
                reach: reach[i],
            }
        })
    }

    /// The part of the span in a range of lattice coordinates.
    pub(crate) fn within(&self, range: &Range<i64>) -> Self {
        let clip = |part: &Range<i64>| {
            let start = part.start.clamp(range.start, range.end);
            start..part.end.clamp(start, range.end)
        };
        let (all, inner) = (clip(&self.all), clip(&self.inner));
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
