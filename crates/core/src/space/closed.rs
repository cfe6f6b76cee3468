//! Counts in closed form, whose cost does not grow with the box.
//!
//! The points of one block have one vector, so those inside of a box are the ones at places of a box of the lattice,
//! and their number is a sum of eight products of three counts along the axes. Counts along an axis differ between
//! vectors only by the few coordinates next to both ends.

use alloc::{vec, vec::Vec};
use core::ops::Range;

use super::{
    lattice::Lattice,
    pattern::products,
    scope::{Scope, common},
};
use crate::{pattern::AxisSet, table::FRACTION_BITS};

/// The number of points of a box without warp at places of a box of the lattice, which is not empty.
pub(super) fn count(scope: &Scope, ranges: &[Range<i64>; 3]) -> u128 {
    of_blocks(&scope.lattice, |axis| Ends {
        clip: ranges[axis].clone(),
        bounds: Some(scope.bounds[axis].clone()),
    })
}

/// The number of points of a lattice at places of a box, wherever they are displaced to.
pub(super) fn count_all(lattice: &Lattice, ranges: &[Range<i64>; 3]) -> u128 {
    if lattice.cut.is_none() {
        return lattice.pattern.count(ranges.clone());
    }
    of_blocks(lattice, |axis| Ends {
        clip: ranges[axis].clone(),
        bounds: None,
    })
}

/// The coordinates of an axis whose points lie inside.
struct Ends {
    /// All of these.
    clip: Range<i64>,
    /// The fixed-point coordinates of points, if they matter.
    bounds: Option<Range<i64>>,
}

impl Ends {
    /// The coordinates of the points that are displaced by a number of fixed-point units.
    #[inline]
    fn range(&self, by: i64) -> Range<i64> {
        match &self.bounds {
            Some(bounds) => {
                let first = |bound: i64| -((by - bound) >> FRACTION_BITS);
                common(&(first(bounds.start)..first(bounds.end)), &self.clip)
            }
            None => self.clip.clone(),
        }
    }
}

/// The numbers of coordinates, by the parity of their own and of the others.
type Numbers = [[u64; 2]; 2];

/// The numbers of coordinates of an axis that hold points, by interval, below each end of a range.
struct Tally {
    ends: Ends,
    lower: Edge,
    upper: Edge,
}

/// The numbers of coordinates below some that follow each other, from a common one on.
struct Edge {
    first: i64,
    /// By coordinate, then by interval.
    below: Vec<Numbers>,
    intervals: usize,
}

impl Edge {
    /// The numbers below the coordinates of a range and its end, given those below its start.
    fn new(lattice: &Lattice, axis: usize, range: &Range<i64>, mut now: Vec<Numbers>) -> Self {
        let mut below = Vec::with_capacity(now.len() * (range.end - range.start + 1) as usize);
        below.extend_from_slice(&now);
        for at in range.clone() {
            add(lattice, axis, at, &mut now);
            below.extend_from_slice(&now);
        }
        Self {
            first: range.start,
            below,
            intervals: now.len(),
        }
    }

    #[inline]
    fn below(&self, at: i64, block: usize) -> &Numbers {
        &self.below[(at - self.first) as usize * self.intervals + block]
    }
}

/// Counts a coordinate.
fn add(lattice: &Lattice, axis: usize, at: i64, numbers: &mut [Numbers]) {
    if let Some(visit) = lattice.pattern.visit(axis, at) {
        let block = lattice.table.map().locate(visit.index);
        numbers[block][usize::from(visit.own)][usize::from(visit.others)] += 1;
    }
}

/// The numbers in a range, by interval.
fn whole(lattice: &Lattice, axis: usize, range: &Range<i64>) -> Vec<Numbers> {
    /// Up to this length visiting each coordinate is faster than closed forms.
    const SHORT: i64 = 4096;
    let map = lattice.table.map();
    let mut numbers = vec![[[0; 2]; 2]; map.intervals()];
    if range.end - range.start <= SHORT {
        for at in range.clone() {
            add(lattice, axis, at, &mut numbers);
        }
        return numbers;
    }
    for (block, numbers) in numbers.iter_mut().enumerate() {
        for own in 0..2u8 {
            for others in 0..2u8 {
                let zero = lattice.pattern.axis_index(axis, 0, others);
                let set = AxisSet::new(map.alpha(), zero, own, map.interval(block));
                let number = set.count(range.clone());
                numbers[usize::from(own)][usize::from(others)] = number;
            }
        }
    }
    numbers
}

impl Tally {
    fn new(lattice: &Lattice, axis: usize, ends: Ends) -> Self {
        let [least, most] = lattice.turned.reach[axis].map(i64::from);
        let [early, late] = [ends.range(most), ends.range(least)];
        let none = vec![[[0; 2]; 2]; lattice.table.map().intervals()];
        let lower = Edge::new(
            lattice,
            axis,
            &(early.start..late.start.max(early.start)),
            none,
        );
        let to_end = whole(lattice, axis, &(early.start..early.end));
        let upper = Edge::new(lattice, axis, &(early.end..late.end.max(early.end)), to_end);
        Self { ends, lower, upper }
    }

    /// The numbers of an interval in the range of points that are displaced by a number of fixed-point units.
    #[inline]
    fn numbers(&self, block: usize, by: i32) -> Numbers {
        let range = self.ends.range(by.into());
        let (below, above) = (
            self.lower.below(range.start, block),
            self.upper.below(range.end, block),
        );
        [0, 1].map(|own| [0, 1].map(|others| above[own][others] - below[own][others]))
    }
}

/// [`products`] whose sum is below 2⁶⁴.
#[inline]
fn products_of_few([x, y, z]: &[Numbers; 3]) -> u64 {
    let layer = |own: usize| {
        let row = |along_y: usize| {
            let [even, odd] = [0, 1].map(|along_x: usize| {
                x[along_x][along_y ^ own] * y[along_y][along_x ^ own] * z[own][along_x ^ along_y]
            });
            even + odd
        };
        row(0) + row(1)
    };
    layer(0) + layer(1)
}

/// The number of points of all blocks.
fn of_blocks(lattice: &Lattice, ends: impl Fn(usize) -> Ends) -> u128 {
    let axes = [0, 1, 2].map(|axis| Tally::new(lattice, axis, ends(axis)));
    let map = lattice.table.map();
    let n = map.intervals();
    let vectors = &lattice.turned.vectors;
    let length = |tally: &Tally| {
        let clip = &tally.ends.clip;
        (clip.end - clip.start) as f64
    };
    let is_small = axes.iter().map(length).product::<f64>() < 9e18;
    let number = |block: usize, columns: Option<&Numbers>| {
        let [i, j, k] = [block % n, block / n % n, block / (n * n)];
        let [x, y, z] = vectors[block];
        let columns = match columns {
            Some(columns) => *columns,
            None => axes[0].numbers(i, x),
        };
        let counts = [columns, axes[1].numbers(j, y), axes[2].numbers(k, z)];
        if is_small {
            products_of_few(&counts).into()
        } else {
            products(&counts)
        }
    };
    let Some(cut) = lattice.cut else {
        return (0..vectors.len()).map(|block| number(block, None)).sum();
    };
    let order = &lattice.turned.order;
    let blocks = (0..cut.whole as usize).filter_map(|position| order.block_at(position));
    let strip = vectors.get(cut.partial as usize).map_or(0, |&[x, ..]| {
        let range = axes[0].ends.range(x.into());
        let start = map.interval(cut.partial as usize % n).start;
        let columns = [0u8, 1].map(|own| {
            [0u8, 1].map(|others| {
                let zero = lattice.pattern.axis_index(0, 0, others);
                AxisSet::new(map.alpha(), zero, own, start..cut.strip_end).count(range.clone())
            })
        });
        number(cut.partial as usize, Some(&columns))
    });
    blocks.map(|block| number(block, None)).sum::<u128>() + strip
}
