//! Tallies: the number of columns or rows of a range in each class and block, all at once.
//!
//! # Why
//!
//! The points of a box are products: (columns of a class) × (rows of a class). If the set has all points of the
//! pattern, two numbers for each class are enough. Otherwise, or where a margin is tested, points of different
//! blocks have different fates, and the count needs for each class the number of columns in each interval of dX and of
//! rows in each interval of dY. Then
//!
//! ```text
//!     points = Σ over classes, Σ over intervals of dY:  rows there × columns whose points these rows have
//! ```
//!
//! which takes n² steps for a box of any size.
//!
//! The map counts the coordinates of all its intervals at once (`map::numbers`). Ranges shorter than some lines for each
//! interval are listed one by one, which is faster there and is the definition in tests.

use alloc::vec::Vec;
use core::ops::Range;

use crate::{
    lattice::{Lattice, Line, lines_of_class},
    pattern::{Axis, Class},
};

/// Counts by class (in the order of [`Class::ordinal`]) and block.
pub(super) type Tally = [Vec<u64>; 4];

/// Listing this many coordinates for each interval takes as long as the sums.
const WORTH: usize = 8;

/// The tally of a range along an axis.
pub(super) fn tally(lattice: &Lattice, axis: Axis, range: &Range<i64>) -> Tally {
    let intervals = lattice.map().intervals();
    if range.end - range.start < (WORTH * intervals) as i64 {
        by_listing(lattice, axis, range)
    } else {
        by_turns(lattice, axis, range)
    }
}

/// The number of points with addresses in some columns and rows.
pub(super) fn product(lattice: &Lattice, columns: &Range<i64>, rows: &Range<i64>) -> u128 {
    if lattice.has_all() {
        return lattice.pattern.count(columns.clone(), rows.clone());
    }
    let tallies = [
        tally(lattice, Axis::X, columns),
        tally(lattice, Axis::Y, rows),
    ];
    let count = |class: Class| {
        let [inner, rows] = [0, 1].map(|axis| tallies[axis][class.ordinal()].as_slice());
        let columns = ColumnTally::new(lattice, class, columns, inner);
        columns.times(rows)
    };
    Class::ALL.into_iter().map(count).sum()
}

/// The columns of a class in a range, by block, as rows see them.
pub(super) struct ColumnTally<'a> {
    lattice: &'a Lattice,
    counts: &'a [u64],
    /// The number of those in the part that the lattice has of a block, for the blocks of which it has a part.
    parts: Vec<([usize; 2], u64)>,
}

impl<'a> ColumnTally<'a> {
    pub(super) fn new(
        lattice: &'a Lattice,
        class: Class,
        range: &Range<i64>,
        counts: &'a [u64],
    ) -> Self {
        let count = |(block, part)| {
            let set = lattice.pattern.axis_subset(Axis::X, class, part);
            (block, set.count(range.clone()))
        };
        Self {
            lattice,
            counts,
            parts: lattice.parts().map(count).collect(),
        }
    }

    /// For each block of dX, the number of columns that have points in the rows of a block of dY.
    pub(super) fn in_row(&self, block_y: usize) -> impl Iterator<Item = u64> + '_ {
        let keeps = self.lattice.keeps(block_y);
        let part = move |block: u32| {
            let part = self
                .parts
                .iter()
                .find(|&&(at, _)| at == [block as usize, block_y]);
            part.map_or(0, |&(_, count)| count)
        };
        (0..).zip(self.counts).map(move |(block, &count)| {
            let line = |strips| Line {
                at: 0,
                block,
                strips,
            };
            match (keeps(&line(0)), keeps(&line(u32::MAX))) {
                (true, _) => count,
                (false, true) => part(block),
                (false, false) => 0,
            }
        })
    }

    /// The number of points of these columns in some rows, given by block.
    pub(super) fn times(&self, rows: &[u64]) -> u128 {
        let total = |counts: &[u64]| counts.iter().map(|&c| u128::from(c)).sum::<u128>();
        if self.lattice.has_all() {
            return total(self.counts) * total(rows);
        }
        let rows = rows.iter().enumerate().filter(|&(_, &rows)| rows > 0);
        rows.map(|(block_y, &rows)| {
            let columns: u128 = self.in_row(block_y).map(u128::from).sum();
            columns * u128::from(rows)
        })
        .sum()
    }
}

fn by_listing(lattice: &Lattice, axis: Axis, range: &Range<i64>) -> Tally {
    Class::ALL.map(|class| {
        let mut counts = alloc::vec![0; lattice.map().intervals()];
        let ranges = [range.clone(), range.end..range.end];
        for line in lines_of_class(lattice, axis, class, ranges) {
            counts[line.block as usize] += 1;
        }
        counts
    })
}

fn by_turns(lattice: &Lattice, axis: Axis, range: &Range<i64>) -> Tally {
    let zero = lattice.pattern.axis_index(axis, 0, 0);
    let mut numbers = lattice.map().numbers(zero, range);
    Class::ALL.map(|class| {
        let (own, other) = match axis {
            Axis::X => (class.x, class.y),
            Axis::Y => (class.y, class.x),
        };
        core::mem::take(&mut numbers[usize::from(own)][usize::from(other)])
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        lattice::{Keep, Placement, PointId, Settle, Spacing, seed::Seed},
        table::{Mix, Ranks, Table},
    };

    proptest! {
        #[test]
        fn turns_agree_with_listing(
            alpha in prop_oneof![Just("(5-sqrt(3))/2"), Just("sqrt(2)"), Just("3/2"), Just("1.07")],
            radius in 0u32..60, seed: u64,
            start in prop_oneof![-3000i64..3000, -(1i64 << 52)..1 << 52], length in 0i64..2500,
        ) {
            let table = Table::undisplaced(alpha.parse().expect("valid"), radius, "test");
            let placement = Placement::new(Spacing::new(1.0).expect("valid"), Seed(seed));
            let lattice = Lattice::new(table.expect("small"), placement);
            let range = start..start + length;
            for axis in [Axis::X, Axis::Y] {
                let expected = by_listing(&lattice, axis, &range);
                prop_assert_eq!(by_turns(&lattice, axis, &range), expected);
            }
        }

        #[test]
        fn products_count_what_is_kept_of_a_kind_or_of_all(
            radius in 0u32..30, seed: u64, kind in proptest::option::of(0u8..3), in_split: bool,
            part in prop_oneof![1e-6..1.0f64, 1e-6..1e-2f64],
            x in -3000i64..3000, y in -(1i64 << 50)..1 << 50, width in 0i64..300, height in 0i64..60,
        ) {
            let table = Table::undisplaced("(5-sqrt(3))/2".parse().expect("valid"), radius, "test");
            let mut table = table.expect("small");
            // The block that is partly kept may be one that is split. The smallest maps have too few for kinds.
            let (mut split, kind) = (0, kind.filter(|_| radius > 2));
            if kind.is_some() {
                let mix = Mix::scattered(table.map(), "3:4:5".parse().expect("valid")).expect("near");
                split = mix.splits()[0].block as usize;
                let ranks = (0..mix.labels().len() as u32).rev().collect();
                table = table.with_mix(mix, Ranks::new(ranks).expect("an order")).expect("fits");
            }
            let split = table.block_ranks(split);
            let share = if in_split { split.start + (split.end - split.start) * part } else { part };
            let share = share.max(1e-6);
            let placement = Placement::new(Spacing::new(1.0).expect("valid"), Seed(seed))
                .with_keep(Keep::new(share).expect("in range"))
                .with_settle(Settle::OFF);
            let mut lattice = Lattice::new(table, placement);
            if let Some(kind) = kind {
                lattice = lattice.of_kind(kind);
            }
            let ids = (y..y + height).flat_map(|y| (x..x + width).map(move |x| PointId { x, y }));
            let kept = ids.filter(|&id| {
                lattice.pattern.contains(id.x, id.y)
                    && kind.is_none_or(|kind| lattice.kind_of(id) == Some(kind))
                    && lattice.rank(id) < share
            });
            let found = product(&lattice, &(x..x + width), &(y..y + height));
            prop_assert_eq!(found, kept.count() as u128);
        }

        #[test]
        fn tallies_of_long_ranges_add_up(
            seed: u64, start in -(1i64 << 52)..1 << 52, length in 0i64..1 << 52, cut in 0.0..1.0f64,
        ) {
            let alpha = "(5-sqrt(3))/2".parse().expect("valid");
            let table = Table::undisplaced(alpha, 49, "test").expect("small");
            let placement = Placement::new(Spacing::new(1.0).expect("valid"), Seed(seed));
            let lattice = Lattice::new(table, placement);
            let middle = start + (length as f64 * cut) as i64;
            let of = |range| by_turns(&lattice, Axis::Y, &range);
            let (whole, a, b) = (of(start..start + length), of(start..middle), of(middle..start + length));
            for class in 0..4 {
                for i in 0..whole[class].len() {
                    prop_assert_eq!(whole[class][i], a[class][i] + b[class][i]);
                }
            }
            let set = lattice.pattern.axis_set(Axis::Y, Class::ALL[2]);
            prop_assert_eq!(whole[2].iter().sum::<u64>(), set.count(start..start + length));
        }
    }
}
