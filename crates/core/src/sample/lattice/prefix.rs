//! Prefix counts: how many columns of a class lie before each column of a band.
//!
//! Rows that are cut into many runs need the place of both ends of each run. A lookup here replaces a
//! search in the list of columns.

use alloc::vec::Vec;
use core::ops::Range;

use super::{Columns, Lattice, Line, places};
use crate::pattern::Class;

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
