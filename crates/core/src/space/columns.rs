//! Columns of planes: the order of points, and the rows of one column.

use alloc::vec::Vec;
use core::ops::Range;

use super::lattice::Lattice;

/// The bits of the width and depth of a column of planes: 1024 lattice units.
pub(super) const COLUMN_BITS: u32 = 10;

/// A coordinate along x that holds points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// The lattice coordinate.
    pub(super) at: i64,
    /// The interval of dX.
    pub(super) block: u32,
    pub(super) index: u64,
}

/// A coordinate along y that holds points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// The lattice coordinate.
    pub(super) at: i64,
    /// The parity of the coordinate.
    pub(super) own: u8,
    /// The parity of the sum of x and z of its points.
    pub(super) others: u8,
    /// The interval of dY.
    pub(super) block: u32,
}

/// The lines along x and y of the points of a column of planes.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    /// Along x, by the parity of the coordinate, and of the sum of the others.
    pub(super) x: [[Vec<Line>; 2]; 2],
    /// Along y, ascending.
    pub(super) y: Vec<Row>,
}

impl Lines {
    /// Lists the lines of a part of the lattice.
    pub(super) fn list(&mut self, lattice: &Lattice, [x, y]: [Range<i64>; 2]) {
        let (pattern, map) = (&lattice.pattern, lattice.table.map());
        self.x.iter_mut().flatten().for_each(Vec::clear);
        for at in x {
            if let Some(visit) = pattern.visit(0, at) {
                self.x[usize::from(visit.own)][usize::from(visit.others)].push(Line {
                    at,
                    block: map.locate(visit.index) as u32,
                    index: visit.index,
                });
            }
        }
        self.y.clear();
        self.y.extend(y.filter_map(|at| {
            let visit = pattern.visit(1, at)?;
            Some(Row {
                at,
                own: visit.own,
                others: visit.others,
                block: map.locate(visit.index) as u32,
            })
        }));
    }
}

/// The columns of planes that a range of coordinates touches.
pub(super) fn columns(range: &Range<i64>) -> Range<i64> {
    if range.is_empty() {
        return 0..0;
    }
    range.start >> COLUMN_BITS..((range.end - 1) >> COLUMN_BITS) + 1
}

/// The coordinates of a column of planes.
pub(super) const fn coordinates(column: i64) -> Range<i64> {
    column << COLUMN_BITS..(column + 1) << COLUMN_BITS
}
