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
}

impl Span {
    /// The span of some fixed-point coordinates.
    pub(crate) fn new(lattice: &Lattice, axis: Axis, bounds: Range<i128>) -> Self {
        let [least, most] = lattice.reach(axis).map(i128::from);
        // The first lattice coordinate at or above a fixed-point one.
        let first = |k: i128| -((-k) >> FRACTION_BITS) as i64;
        let all = if bounds.is_empty() {
            let start = first(bounds.start);
            start..start
        } else {
            first(bounds.start - most)..first(bounds.end - least)
        };
        let inner = first(bounds.start - least)..first(bounds.end - most);
        let inner = if inner.is_empty() || all.is_empty() {
            all.end..all.end
        } else {
            inner
        };
        Self { bounds, all, inner }
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
