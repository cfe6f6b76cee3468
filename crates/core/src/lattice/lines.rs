//! Lists of the columns and rows that hold points, and how many columns of a class lie before each column of a band.
//!
//! Rows that are cut into many runs need the place of both ends of each run. A lookup here replaces a
//! search in the list of columns.

use alloc::vec::Vec;
use core::ops::Range;

use super::{Lattice, Line};
use crate::pattern::{Axis, Class};

/// The columns of a range of the lattice, by class, ascending.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns {
    all: [Vec<Line>; 4],
    /// In a set without all points: those that have points in the rows of a block, by class and block.
    kept: Vec<Kept>,
}

/// The columns of a class that have points in the rows of a block.
#[derive(Clone, Debug, Default)]
struct Kept {
    lines: Vec<Line>,
    is_made: bool,
}

impl Columns {
    /// Replaces the lists by those of another range.
    pub(crate) fn list(&mut self, lattice: &Lattice, range: Range<i64>) {
        let length = usize::try_from(range.end.saturating_sub(range.start)).unwrap_or(0);
        for list in &mut self.all {
            list.clear();
            // A class has a quarter of all columns at most, where α is largest. Few columns take few lists.
            if length >= 16 {
                list.reserve(length / 4 + 4);
            }
        }
        for at in range {
            if let Some((class, index)) = lattice.pattern.visit(Axis::X, at) {
                self.all[class.ordinal()].push(lattice.line(at, index));
            }
        }
        self.kept.iter_mut().for_each(|kept| kept.is_made = false);
    }

    /// All columns of a class.
    #[inline]
    pub(crate) fn of(&self, class: Class) -> &[Line] {
        &self.all[class.ordinal()]
    }

    /// The columns that have points in the rows of a class and block.
    #[inline]
    pub(crate) fn of_row(&mut self, lattice: &Lattice, class: Class, block_y: usize) -> &[Line] {
        if lattice.has_all() {
            return &self.all[class.ordinal()];
        }
        self.keep(lattice, class, block_y)
    }

    fn keep(&mut self, lattice: &Lattice, class: Class, block_y: usize) -> &[Line] {
        let n = lattice.map().intervals();
        self.kept.resize_with(4 * n, Kept::default);
        let kept = &mut self.kept[class.ordinal() * n + block_y];
        if !kept.is_made {
            kept.lines.clear();
            let keeps = lattice.keeps(block_y);
            let all = self.all[class.ordinal()].iter();
            kept.lines.extend(all.filter(|line| keeps(line)));
            kept.is_made = true;
        }
        &kept.lines
    }

    /// The places of a range of coordinates in the list of each class.
    pub(crate) fn places(&self, range: &Range<i64>) -> [Range<usize>; 4] {
        Class::ALL.map(|class| places(self.of(class), range))
    }
}

/// The places of a range of coordinates in a list of columns.
pub(crate) fn places(lines: &[Line], range: &Range<i64>) -> Range<usize> {
    let before = |v: i64| lines.partition_point(|line| line.at < v);
    before(range.start)..before(range.end)
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
        lattice.line(at, index)
    })
}

/// For each lattice column of a range, and for its end, the number of listed columns before it, by
/// class.
#[derive(Clone, Debug, Default)]
pub(crate) struct PrefixCounts {
    start: i64,
    counts: Vec<[u16; 4]>,
}

impl PrefixCounts {
    /// Replaces the counts by those of the lists of a range within a band.
    pub(crate) fn update(&mut self, range: &Range<i64>, columns: &Columns) {
        self.start = range.start;
        self.counts.clear();
        let mut before = [0u16; 4];
        for x in range.start..=range.end {
            self.counts.push(before);
            // Columns of one parity belong to two of the classes.
            let parity = (x & 1) as usize;
            for class in [Class::ALL[parity], Class::ALL[parity + 2]] {
                let count = &mut before[class.ordinal()];
                let next = columns.of(class).get(usize::from(*count));
                *count += u16::from(next.is_some_and(|line| line.at == x));
            }
        }
    }

    /// The places of a range of columns in the list of a row's columns: all of its class, or in a set
    /// without all points some of them, which are searched.
    #[inline]
    pub(crate) fn places(
        &self,
        lattice: &Lattice,
        class: Class,
        columns: &[Line],
        range: &Range<i64>,
    ) -> Range<usize> {
        if lattice.has_all() {
            self.before(class, range.start)..self.before(class, range.end)
        } else {
            places(columns, range)
        }
    }

    /// The number of columns of a class before a column in the range, or before its end.
    #[inline]
    pub(crate) fn before(&self, class: Class, x: i64) -> usize {
        usize::from(self.counts[(x - self.start) as usize][class.ordinal()])
    }
}
