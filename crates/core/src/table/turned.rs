//! A table turned by a symmetry.

use alloc::{sync::Arc, vec::Vec};

use super::{Displacement, Labels, Order, TableOf, symmetry::Symmetry};
use crate::once::Once;

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

    /// The table as it is.
    pub(crate) const fn table(&self) -> &TableOf<Displacement> {
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
    use crate::{map::Map, table::Table};

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
