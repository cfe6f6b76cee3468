//! How many columns of a class lie before a lattice column of a band, at hand for every column.
//!
//! Templates that keep all columns, and lists of columns, are counted through it: rows cut into many
//! runs need a lookup for each end where they would search.

use alloc::vec::Vec;
use core::ops::Range;

use super::Listed;
use crate::pattern::Class;

/// For each lattice column, and for the one after the last, how many listed ones lie before, by
/// class.
#[derive(Clone, Debug, Default)]
pub(super) struct Before {
    start: i64,
    counts: Vec<[u16; 4]>,
}

impl Before {
    /// Takes note of the lists of a stretch of a band.
    pub(super) fn note(&mut self, range: &Range<i64>, lists: &[Listed; 4]) {
        self.start = range.start;
        self.counts.clear();
        let mut before = [0u16; 4];
        for x in range.start..=range.end {
            self.counts.push(before);
            // Columns of one parity are in two of the classes.
            let parity = (x & 1) as usize;
            for class in [parity, parity + 2] {
                let next = lists[class].get(usize::from(before[class]));
                before[class] += u16::from(next.is_some_and(|&(v, _)| v == x));
            }
        }
    }

    /// How many columns of a class lie before a column within the stretch, or before its end.
    #[inline]
    pub(super) fn count(&self, class: Class, x: i64) -> usize {
        usize::from(self.counts[(x - self.start) as usize][class.ordinal()])
    }
}
