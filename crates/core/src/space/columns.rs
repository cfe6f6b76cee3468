//! Columns of planes: the order of points, and the rows of one column.

use alloc::vec::Vec;
use core::ops::Range;

use super::lattice::{Lattice, fixed};

/// The bits of the width and depth of a column of planes: 1024 lattice units.
pub(super) const COLUMN_BITS: u32 = 10;

/// Coordinates along x that hold points, ascending.
#[derive(Clone, Debug, Default)]
pub(super) struct Across {
    /// The lattice coordinates relative to the origin, in fixed-point units.
    pub(super) at: Vec<i32>,
    /// The intervals of dX.
    pub(super) blocks: Vec<u16>,
    pub(super) indices: Vec<u64>,
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
    /// The number of times that they were listed.
    pub(super) number: u64,
    /// Along x, by the parity of the coordinate, and of the sum of the others.
    pub(super) x: [[Across; 2]; 2],
    /// Along y, ascending.
    pub(super) y: Vec<Row>,
}

impl Lines {
    /// Lists the lines of a part of the lattice, along x from an origin on.
    pub(super) fn list(&mut self, lattice: &Lattice, origin: i64, [x, y]: [Range<i64>; 2]) {
        self.number += 1;
        let (pattern, map) = (&lattice.pattern, lattice.table.map());
        for across in self.x.iter_mut().flatten() {
            across.at.clear();
            across.blocks.clear();
            across.indices.clear();
        }
        for at in x {
            if let Some(visit) = pattern.visit(0, at) {
                let across = &mut self.x[usize::from(visit.own)][usize::from(visit.others)];
                across.at.push(fixed(at - origin) as i32);
                across.blocks.push(map.locate(visit.index) as u16);
                across.indices.push(visit.index);
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
