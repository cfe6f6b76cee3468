//! Lists of the columns and rows that hold points.

use alloc::vec::Vec;
use core::ops::Range;

use super::Lattice;
use crate::pattern::{Axis, Class};

/// A column or row that holds points: its coordinate, and its interval of dX or dY.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Line {
    pub(crate) at: i64,
    pub(crate) block: u32,
}

/// The columns of a range of the lattice, by class, ascending.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns([Vec<Line>; 4]);

impl Columns {
    /// Replaces the lists by those of another range.
    pub(crate) fn list(&mut self, lattice: &Lattice, range: Range<i64>) {
        let length = usize::try_from(range.end.saturating_sub(range.start)).unwrap_or(0);
        for list in &mut self.0 {
            list.clear();
            // A class has a quarter of all columns at most, where α is largest.
            list.reserve(length / 4 + 4);
        }
        for at in range {
            if let Some((class, index)) = lattice.pattern.visit(Axis::X, at) {
                let block = lattice.map().locate(index) as u32;
                self.0[class.ordinal()].push(Line { at, block });
            }
        }
    }

    /// The columns of a class.
    #[inline]
    pub(crate) fn of(&self, class: Class) -> &[Line] {
        &self.0[class.ordinal()]
    }

    /// The places of a range of coordinates in the list of each class.
    pub(crate) fn places(&self, range: &Range<i64>) -> [Range<usize>; 4] {
        Class::ALL.map(|class| {
            let before = |v: i64| self.of(class).partition_point(|line| line.at < v);
            before(range.start)..before(range.end)
        })
    }
}

/// The columns or rows of a class in two ranges.
pub(crate) fn lines_of_class(
    lattice: &Lattice,
    axis: Axis,
    class: Class,
    ranges: [Range<i64>; 2],
) -> impl Iterator<Item = Line> {
    let other_parity = match axis {
        Axis::X => class.y,
        Axis::Y => class.x,
    };
    let set = lattice.pattern.axis_set(axis, class);
    let all = ranges.into_iter().flat_map(move |range| set.iter(range));
    all.map(move |at| {
        let index = lattice.pattern.axis_index(axis, at, other_parity);
        let block = lattice.map().locate(index) as u32;
        Line { at, block }
    })
}
