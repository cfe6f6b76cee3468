//! The course of a walk: columns of 1024 × 1024 places one after another, in a column planes, in a plane rows.
//!
//! Planes are walked in slabs of 32, whose [`Cells`] tell where points need a test. Positions are 32-bit offsets from
//! the origin of a patch, a slab of 256 rows.
//!
//! Points are warped in groups, whose extents tell which cells of the warp they can touch.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use crate::{
    kernel::{Extents, GROUP},
    space::{
        cells::{CELL_BITS, Cells, Run},
        columns::{COLUMN_BITS, Lines, Row, columns, coordinates},
        lattice::fixed,
        scope::{Scope, common},
        template::Plane,
    },
    table::FRACTION_BITS,
};

/// The bits of the height of a patch.
pub(super) const PATCH_BITS: u32 = 8;
/// Up to this side, in lattice units, all points are tested.
const SMALL: i64 = 96;

/// Where a walk is.
#[derive(Clone, Debug)]
pub(super) struct Course {
    pub(super) scope: Arc<Scope>,
    /// The places that are walked.
    pub(super) ranges: [Range<i64>; 3],
    /// The first place, unless that is the first of all.
    start: Option<[i64; 3]>,
    /// The next column.
    next: [i64; 2],
    pub(super) column: Column,
    pub(super) slab: Slab,
    pub(super) plane: Option<Plane>,
}

/// A column of planes.
#[derive(Clone, Debug, Default)]
pub(super) struct Column {
    pub(super) ranges: [Range<i64>; 2],
    /// The origin of the first patch along x and y.
    origin: [i64; 2],
    pub(super) lines: Lines,
    /// The next plane.
    z: i64,
    /// The next row of the plane.
    row: usize,
}

/// A slab of planes.
#[derive(Clone, Debug, Default)]
pub(super) struct Slab {
    pub(super) planes: Range<i64>,
    pub(super) cells: Cells,
    /// The number of slabs before it.
    pub(super) number: u64,
}

impl Course {
    /// The course over the places of a box, from a place on.
    pub(super) fn new(
        scope: Arc<Scope>,
        ranges: &[Range<i64>; 3],
        start: Option<[i64; 3]>,
    ) -> Self {
        let mut ranges = scope.clip(ranges);
        if ranges.iter().any(Range::is_empty) {
            ranges = [0..0, 0..0, 0..0];
        }
        let first = match start {
            Some([x, y, _]) => [x >> COLUMN_BITS, y >> COLUMN_BITS],
            None => [0, 1].map(|axis| columns(&ranges[axis]).start),
        };
        let mut course = Self {
            next: first,
            ranges,
            start,
            column: Column::default(),
            slab: Slab::default(),
            plane: None,
            scope,
        };
        // No planes are left of a column that there is not.
        course.column.z = i64::MAX;
        course
    }

    /// Whether the next plane is one of the slab.
    pub(super) fn stays_in_slab(&self) -> bool {
        let z = self.column.z;
        self.slab.planes.contains(&z) && z < self.ranges[2].end
    }

    /// The next row of the plane that may have points, or `None` at its end.
    pub(super) fn row(&self, plane: Plane) -> Option<(usize, Row)> {
        // The sum of x and y must have the parity that the plane demands, and that of x and z the row's.
        let others = plane.others ^ plane.own;
        let rows = self.column.lines.y.get(self.column.row..)?;
        let next = rows.iter().position(|row| row.others ^ row.own == others)?;
        Some((self.column.row + next, rows[next]))
    }

    /// Goes beyond a row.
    pub(super) fn pass(&mut self, number: usize) {
        self.column.row = number + 1;
    }

    /// The patch of a row.
    pub(super) fn patch(&self, row: Row) -> usize {
        ((row.at - self.column.origin[1]) >> PATCH_BITS) as usize
    }

    /// The number of patches of the column.
    pub(super) fn patches(&self) -> usize {
        ((self.column.ranges[1].end - 1 - self.column.origin[1]) >> PATCH_BITS) as usize + 1
    }

    /// The runs of cells of a row.
    pub(super) fn runs(&self, row: Row) -> &[Run] {
        let offset = row.at - self.column.origin[1];
        self.slab.cells.row((offset >> CELL_BITS) as usize)
    }

    /// The origin of a patch of the slab.
    pub(super) fn origin(&self, patch: usize) -> [i64; 3] {
        let [x, y] = self.column.origin;
        let z = self.slab.planes.start;
        [x, y + ((patch as i64) << PATCH_BITS), z]
    }

    /// The first column of a row of the plane, if it is not the first of all, from an origin on in fixed-point units.
    pub(super) fn first(&self, plane: Plane, row: Row, origin: i64) -> Option<i32> {
        let [x, y, z] = self.start?;
        ([y, z] == [row.at, plane.at]).then(|| fixed(x - origin) as i32)
    }

    /// Goes to the next plane, or to the next column. Returns false at the end.
    pub(super) fn next_plane(&mut self) -> bool {
        if self.scope.stop.is_raised() {
            return false;
        }
        if self.column.z >= self.ranges[2].end {
            return self.next_column();
        }
        let at = self.column.z;
        self.column.z += 1;
        let lattice = &self.scope.lattice;
        let Some(visit) = lattice.pattern.visit(2, at) else {
            return true;
        };
        let map = lattice.table.map();
        self.plane = Some(Plane {
            at,
            own: visit.own,
            others: visit.others,
            block: map.locate(visit.index),
        });
        self.column.row = 0;
        if let Some([_, y, z]) = self.start
            && z == at
        {
            self.column.row = self.column.lines.y.partition_point(|row| row.at < y);
        }
        if !self.slab.planes.contains(&at) {
            self.next_slab(at);
        }
        true
    }

    /// Goes to the next column. Returns false at the end.
    fn next_column(&mut self) -> bool {
        let [x, y] = [0, 1].map(|axis| columns(&self.ranges[axis]));
        if self.next[1] >= y.end {
            self.next = [self.next[0] + 1, y.start];
        }
        let [column, row] = self.next;
        if column >= x.end || y.is_empty() {
            return false;
        }
        self.next[1] += 1;
        let ranges = [
            common(&coordinates(column), &self.ranges[0]),
            common(&coordinates(row), &self.ranges[1]),
        ];
        self.column.origin = ranges
            .clone()
            .map(|range| range.start & !((1 << CELL_BITS) - 1));
        let [origin, _] = self.column.origin;
        self.column
            .lines
            .list(&self.scope.lattice, origin, ranges.clone());
        self.column.ranges = ranges;
        self.column.z = self.ranges[2].start;
        self.slab.planes = 0..0;
        match self.start {
            Some([x, y, z]) if [x >> COLUMN_BITS, y >> COLUMN_BITS] == [column, row] => {
                self.column.z = self.column.z.max(z);
            }
            _ => self.start = None,
        }
        true
    }

    /// Goes to the slab of a plane.
    fn next_slab(&mut self, at: i64) {
        let first = at & !((1 << CELL_BITS) - 1);
        let [x, y] = &self.column.ranges;
        let planes = common(&(first..first + (1 << CELL_BITS)), &self.ranges[2]);
        let ranges = [x.clone(), y.clone(), planes.clone()];
        let [origin_x, origin_y] = self.column.origin;
        let is_small = self
            .scope
            .all
            .iter()
            .all(|range| range.end - range.start <= SMALL);
        if is_small || self.scope.is_box() {
            let rows = (y.end - 1 - origin_y) >> CELL_BITS;
            self.slab.cells.test_all(rows as usize + 1);
        } else {
            let origin = [origin_x, origin_y, first];
            self.slab.cells.look(&self.scope, &ranges, origin);
        }
        self.slab.number += 1;
        self.slab.planes = first..first + (1 << CELL_BITS);
    }
}

/// Extends the extents of groups by points of a row from a position on, whose columns are in fixed-point units.
pub(super) fn cover(extents: &mut Vec<Extents>, start: usize, columns: &[i32], [y, z]: [i32; 2]) {
    let mut rest = columns;
    let mut position = start;
    while !rest.is_empty() {
        let group = position / GROUP;
        let (here, after) = rest.split_at(((group + 1) * GROUP - position).min(rest.len()));
        let [first, last] = [here[0], here[here.len() - 1]].map(|x| x >> FRACTION_BITS);
        let row = [[first, last], [y, y], [z, z]];
        match extents.get_mut(group) {
            Some(all) => {
                for (ends, [least, most]) in all.iter_mut().zip(row) {
                    *ends = [ends[0].min(least), ends[1].max(most)];
                }
            }
            None => extents.push(row),
        }
        position += here.len();
        rest = after;
    }
}
