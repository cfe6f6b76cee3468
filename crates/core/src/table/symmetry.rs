//! Turned tables: the vectors under the symmetries of the square.
//!
//! The thresholds of a map are symmetric: a neighbor shift s and its opposite mirror each other about the
//! middle of the set region. Reflecting the plane along an axis therefore reverses the order of the blocks of
//! that axis, reflecting it about the diagonal swaps the axes of the blocks, and a table turned with them
//! makes the reflected point set: the pattern is the same one with another origin. The order in which blocks
//! leave and the vectors of a ladder turn alike. Only the strip of the one block that is partly kept runs along
//! dX in every turned table.

use alloc::{sync::Arc, vec::Vec};

use super::{Displacement, Ladder, Order, Table, ladder::Stage};
use crate::once::Once;

/// A symmetry of the square: an exchange of the axes, if any, and then reflections along x and y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Symmetry {
    is_swapped: bool,
    is_reversed: [bool; 2],
}

/// The number of symmetries.
const ALL: usize = 8;

impl Symmetry {
    /// The symmetry of three bits: the lowest reverses x, the next y, the highest exchanges the axes.
    pub(crate) const fn from_bits(bits: u64) -> Self {
        Self {
            is_swapped: bits & 4 != 0,
            is_reversed: [bits & 1 != 0, bits & 2 != 0],
        }
    }

    const fn number(self) -> usize {
        let [x, y] = self.is_reversed;
        x as usize | (y as usize) << 1 | (self.is_swapped as usize) << 2
    }

    /// The column and row of a map of `n` intervals whose entry a turned table has at a column and row.
    pub(crate) fn source(self, n: usize, block: [usize; 2]) -> [usize; 2] {
        let [x, y] = [0, 1].map(|i| match self.is_reversed[i] {
            true => n - 1 - block[i],
            false => block[i],
        });
        if self.is_swapped { [y, x] } else { [x, y] }
    }

    /// A vector of the table, turned.
    fn turn(self, [x, y]: Displacement) -> Displacement {
        let [x, y] = if self.is_swapped { [y, x] } else { [x, y] };
        let signed = |v: i32, is_reversed: bool| if is_reversed { -v } else { v };
        [
            signed(x, self.is_reversed[0]),
            signed(y, self.is_reversed[1]),
        ]
    }
}

/// The vectors of a table and the order of its blocks under a symmetry.
#[derive(Clone, Debug)]
pub(crate) struct TurnedTable {
    /// `None` for the table's own.
    turned: Option<Arc<Turned>>,
    table: Table,
    symmetry: Symmetry,
    /// The least and the greatest displacement along x and y.
    reach: [[i32; 2]; 2],
}

#[derive(Debug)]
struct Turned {
    vectors: Vec<Displacement>,
    order: Order,
}

/// The turned copies of a table, made when they are first needed.
#[derive(Debug)]
pub(super) struct TurnedCopies([Once<Arc<Turned>>; ALL]);

impl TurnedCopies {
    /// The number of copies that a table may come to hold.
    pub(super) const MOST: usize = ALL - 1;

    pub(super) const fn new() -> Self {
        Self([const { Once::new() }; ALL])
    }
}

impl TurnedTable {
    pub(crate) fn new(table: &Table, symmetry: Symmetry) -> Self {
        let (n, vectors) = (table.map().intervals(), table.displacements());
        let turned = (symmetry != Symmetry::default()).then(|| {
            table.turned().0[symmetry.number()].get_or(|| {
                let source = |block: usize| {
                    let [x, y] = symmetry.source(n, [block % n, block / n]);
                    y * n + x
                };
                let vector = |block| symmetry.turn(vectors[source(block)]);
                Arc::new(Turned {
                    vectors: (0..n * n).map(vector).collect(),
                    order: table.order().turned(source),
                })
            })
        });
        let [x, y] = table.reach();
        let ends = [0, 1].map(|end| symmetry.turn([x[end], y[end]]));
        Self {
            turned,
            table: table.clone(),
            symmetry,
            reach: [0, 1].map(|axis| {
                let [a, b] = ends.map(|end| end[axis]);
                [a.min(b), a.max(b)]
            }),
        }
    }

    /// The vectors of all blocks with one interval of dY.
    #[inline]
    pub(crate) fn row(&self, block_y: usize) -> &[Displacement] {
        let all = match &self.turned {
            Some(turned) => &turned.vectors,
            None => self.table.displacements(),
        };
        let n = self.table.map().intervals();
        &all[block_y * n..][..n]
    }

    /// The vector of a block.
    #[inline]
    pub(crate) fn vector(&self, block: usize) -> Displacement {
        match &self.turned {
            Some(turned) => turned.vectors[block],
            None => self.table.displacements()[block],
        }
    }

    /// The order in which blocks leave.
    #[inline]
    pub(crate) fn order(&self) -> &Order {
        match &self.turned {
            Some(turned) => &turned.order,
            None => self.table.order(),
        }
    }

    /// The displacement of the block at a position of the order, at a stage of the table's ladder.
    #[inline]
    pub(crate) fn moved(&self, ladder: &Ladder, stage: Stage, position: usize) -> Displacement {
        let full = self.table.displacements()[self.table.order().block(position)];
        self.symmetry
            .turn(ladder.displacement(stage, position, full))
    }

    /// The table as it is.
    pub(crate) const fn table(&self) -> &Table {
        &self.table
    }

    /// The least and the greatest displacement along x and y.
    pub(crate) const fn reach(&self) -> [[i32; 2]; 2] {
        self.reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Map;

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

    #[test]
    fn symmetries_are_a_group_of_eight() {
        let all: Vec<_> = (0..8).map(Symmetry::from_bits).collect();
        let images = |s: &Symmetry| [[3, 1], [1, 0]].map(|v| s.turn(v));
        for (i, a) in all.iter().enumerate() {
            assert_eq!(a.number(), i);
            assert!(all[..i].iter().all(|b| images(a) != images(b)));
            // Turning a place and turning its block agree.
            let [x, y] = a.source(5, [3, 1]).map(|v| v as i32 - 2);
            assert_eq!(a.turn([x, y]), [1, -1]);
        }
    }

    #[test]
    fn a_turned_table_reaches_as_far() {
        let map = Map::new("sqrt(3)".parse().expect("valid"), 9).expect("small");
        let n = map.intervals() as i32;
        let vectors = (0..n * n).map(|i| [i * 37 % 101 - 20, i * 53 % 89 - 70]);
        let table = Table::new(map, "test", vectors.collect(), Default::default()).expect("valid");
        for bits in 0..8 {
            let vectors = TurnedTable::new(&table, Symmetry::from_bits(bits));
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
