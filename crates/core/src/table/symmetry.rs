//! The symmetries of the square and of the cube, by which seeds turn tables, and tables turned by them.
//!
//! The thresholds of a map are symmetric: a neighbor shift s and its opposite mirror each other about the
//! middle of the set region. Reflecting the plane along an axis therefore reverses the order of the blocks of
//! that axis, reflecting it about the diagonal swaps the axes of the blocks, and a table turned with them
//! makes the reflected point set: the pattern is the same one with another origin. The order in which blocks
//! leave and the kinds of points turn alike. Only the strips of blocks that are partly kept, or that have two
//! kinds, run along dX in every turned table. In space all of this holds for three axes.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Neg;

use super::{Displacement, Labels, Order, TableOf};
use crate::once::Once;

/// A symmetry of the square or of the cube: an exchange of the axes, if any, and then reflections along them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Symmetry<const D: usize> {
    number: usize,
    /// The axis of the table that each axis of the set shows.
    axes: [usize; D],
}

impl Symmetry<2> {
    /// The number of symmetries of the square.
    pub(crate) const ALL: usize = 8;

    /// Symmetry number `number`: the lowest bits reverse x and y, the highest exchanges the axes.
    pub(crate) const fn numbered(number: usize) -> Self {
        let axes = [[0, 1], [1, 0]][number >> 2];
        Self { number, axes }
    }
}

impl Symmetry<3> {
    /// The number of symmetries of the cube.
    pub(crate) const ALL: usize = 48;
    /// The orders of three axes.
    const ORDERS: [[usize; 3]; 6] = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];

    /// Symmetry number `number`: the lowest three bits reverse axes.
    pub(crate) const fn numbered(number: usize) -> Self {
        let axes = Self::ORDERS[number >> 3];
        Self { number, axes }
    }
}

impl<const D: usize> Symmetry<D> {
    /// The number of the symmetry; 0 leaves the table as it is.
    pub(crate) const fn number(self) -> usize {
        self.number
    }

    const fn is_reversed(self, axis: usize) -> bool {
        self.number >> axis & 1 != 0
    }

    /// The block of a map of `n` intervals whose entry a turned table has at a block.
    pub(crate) fn source(self, n: usize, mut block: usize) -> usize {
        let mut source = [0; D];
        for (axis, &shown) in self.axes.iter().enumerate() {
            let place = block % n;
            block /= n;
            source[shown] = if self.is_reversed(axis) {
                n - 1 - place
            } else {
                place
            };
        }
        source
            .iter()
            .rev()
            .fold(0, |block, place| block * n + place)
    }

    /// A vector of the table as one of the set.
    #[inline(always)]
    pub(crate) fn turn<T: Copy + Neg<Output = T>>(self, vector: [T; D]) -> [T; D] {
        core::array::from_fn(|axis| {
            let v = vector[self.axes[axis]];
            if self.is_reversed(axis) { -v } else { v }
        })
    }
}

/// What is derived from the vectors of a table of the plane.
#[derive(Debug)]
pub struct Held {
    /// The least and the greatest displacement along x and y.
    reach: [[i32; 2]; 2],
    /// The least squared distance of each pair of kinds, row by row.
    pub(super) least_of_kinds: Once<Arc<[u64]>>,
    /// The copies for the symmetries but the first, made when they are first needed.
    turned: [Once<Arc<Turned>>; Self::COPIES],
}

impl Held {
    /// The number of copies that a table may come to hold.
    pub(super) const COPIES: usize = Symmetry::<2>::ALL - 1;

    pub(super) fn new(vectors: &[Displacement]) -> Self {
        let mut reach = [[i32::MAX, i32::MIN]; 2];
        for vector in vectors {
            for (ends, &v) in reach.iter_mut().zip(vector) {
                *ends = [ends[0].min(v), ends[1].max(v)];
            }
        }
        Self {
            reach,
            least_of_kinds: Once::new(),
            turned: [const { Once::new() }; Self::COPIES],
        }
    }
}

/// The entries of a table for each block, turned.
#[derive(Debug)]
struct Turned {
    vectors: Vec<Displacement>,
    order: Order,
    labels: Option<Labels>,
}

impl Turned {
    fn new(table: &TableOf<Displacement>, symmetry: Symmetry<2>) -> Self {
        let (map, vectors) = (table.map(), table.displacements());
        let source = |block: usize| symmetry.source(map.intervals(), block);
        let vector = |block| symmetry.turn(vectors[source(block)]);
        let labels = table.mix();
        Self {
            vectors: (0..vectors.len()).map(vector).collect(),
            order: table.order().turned(source),
            labels: labels.map(|mix| Labels::new(map, mix, source)),
        }
    }
}

/// The vectors of a table and the order of its blocks under a symmetry.
#[derive(Clone, Debug)]
pub(crate) struct TurnedTable {
    /// `None` for the table's own.
    turned: Option<Arc<Turned>>,
    table: TableOf<Displacement>,
    /// The least and the greatest displacement along x and y.
    reach: [[i32; 2]; 2],
}

impl TurnedTable {
    pub(crate) fn new(table: &TableOf<Displacement>, symmetry: Symmetry<2>) -> Self {
        let make = || Arc::new(Turned::new(table, symmetry));
        let copy = symmetry.number().checked_sub(1);
        let turned = copy.map(|copy| table.held().turned[copy].get_or(make));
        let [x, y] = table.held().reach;
        let ends = [0, 1].map(|end| symmetry.turn([x[end], y[end]]));
        Self {
            turned,
            table: table.clone(),
            reach: [0, 1].map(|axis| {
                let [a, b] = ends.map(|end| end[axis]);
                [a.min(b), a.max(b)]
            }),
        }
    }

    /// The vectors of all blocks: those with one interval of dY one after another.
    #[inline]
    pub(crate) fn vectors(&self) -> &[Displacement] {
        match &self.turned {
            Some(turned) => &turned.vectors,
            None => self.table.displacements(),
        }
    }

    /// The vectors of all blocks with one interval of dY.
    #[inline]
    pub(crate) fn row(&self, block_y: usize) -> &[Displacement] {
        let n = self.table.map().intervals();
        &self.vectors()[block_y * n..][..n]
    }

    /// The order in which blocks leave.
    #[inline]
    pub(crate) fn order(&self) -> &Order {
        match &self.turned {
            Some(turned) => &turned.order,
            None => self.table.order(),
        }
    }

    /// The kinds of the points of each block.
    #[inline]
    pub(crate) fn labels(&self) -> Option<&Labels> {
        match &self.turned {
            Some(turned) => turned.labels.as_ref(),
            None => self.table.labels(),
        }
    }

    /// The least and the greatest displacement along x and y.
    pub(crate) const fn reach(&self) -> [[i32; 2]; 2] {
        self.reach
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;
    use crate::{map::Map, table::Table};

    #[test]
    fn maps_are_symmetric() {
        for (alpha, radius) in [
            ("(5-sqrt(3))/2", 49),
            ("sqrt(3)", 20),
            ("(1+sqrt(5))/2", 100),
        ] {
            let map = Map::new(alpha.parse().expect("valid"), radius).expect("small");
            let (side, n) = (map.alpha().set_side(), map.intervals());
            for i in 0..n {
                let (own, mirrored) = (map.interval(i), map.interval(n - 1 - i));
                assert_eq!(own.start, side - mirrored.end);
            }
        }
    }

    /// All symmetries turn a vector of different components to different ones, and places as their blocks.
    fn are_different<const D: usize>(all: Vec<Symmetry<D>>, vector: [i32; D]) {
        for (i, a) in all.iter().enumerate() {
            assert_eq!(a.number(), i);
            assert!(all[..i].iter().all(|b| b.turn(vector) != a.turn(vector)));
            // A place from the middle of a map of 9 intervals, as a block.
            let block = |at: [i32; D]| {
                at.iter()
                    .rev()
                    .fold(0, |block, v| block * 9 + (v + 4) as usize)
            };
            assert_eq!(a.source(9, block(a.turn(vector))), block(vector));
        }
    }

    #[test]
    fn symmetries_are_different() {
        are_different((0..8).map(Symmetry::<2>::numbered).collect(), [3, 1]);
        are_different((0..48).map(Symmetry::<3>::numbered).collect(), [1, -2, 3]);
    }

    #[test]
    fn a_turned_table_reaches_as_far() {
        let map = Map::new("sqrt(3)".parse().expect("valid"), 9).expect("small");
        let n = map.intervals() as i32;
        let vectors = (0..n * n).map(|i| [i * 37 % 101 - 20, i * 53 % 89 - 70]);
        let table = Table::new(map, "test", vectors.collect(), Default::default()).expect("valid");
        for bits in 0..8 {
            let vectors = TurnedTable::new(&table, Symmetry::<2>::numbered(bits));
            let all = (0..n as usize).flat_map(|row| vectors.row(row));
            let mut reach = [[i32::MAX, i32::MIN]; 2];
            for v in all {
                for axis in 0..2 {
                    reach[axis] = [reach[axis][0].min(v[axis]), reach[axis][1].max(v[axis])];
                }
            }
            assert_eq!(reach, vectors.reach());
        }
    }
}
