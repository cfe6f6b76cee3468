//! The walk over the points of a scope, in order, batch by batch.
//!
//! Columns of 1024 × 1024 places come one after another; in a column planes, in a plane rows, in a row points by x.
//! Planes are walked in slabs of 32, whose [`Cells`] tell where points need a test. Positions are 32-bit offsets from
//! the origin of a patch, a slab of 256 rows.

mod finish;

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use super::{
    batch::Batch,
    cells::{CELL_BITS, Cells, IN, OUT, TEST},
    columns::{COLUMN_BITS, Lines, Row, columns, coordinates},
    lattice::fixed,
    scope::{Scope, common},
    template::{Plane, Templates},
};
use crate::{
    sample::{Backend, space::PatchShears},
    table::FRACTION_BITS,
};

/// The bits of the height of a patch.
pub(super) const PATCH_BITS: u32 = 8;
/// The bits of the height of a slab.
pub(super) const SLAB_BITS: u32 = CELL_BITS;
/// A batch ends with the row that makes it as long.
const LONG: usize = 512;
/// Up to this side, in lattice units, all points are tested.
const SMALL: i64 = 96;

/// A walk over the points of a scope.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    scope: Arc<Scope>,
    /// The places that are walked.
    ranges: [Range<i64>; 3],
    /// The first place, unless that is the first of all.
    start: Option<[i64; 3]>,
    wants_ids: bool,
    pub(super) backend: Backend,
    /// The next column.
    next: [i64; 2],
    column: Column,
    slab: Slab,
    plane: Option<Plane>,
    templates: Templates,
    /// The points of the rows so far, before the warp if there is one.
    pending: Batch,
    /// The values that these have in common.
    key: Key,
    /// Room for warped places.
    room: [Vec<i32>; 2],
    /// The parts of the batch that are no points.
    gaps: Vec<Range<usize>>,
    /// Where the rows begin that no gap follows.
    row_start: usize,
}

/// A column of planes.
#[derive(Clone, Debug, Default)]
struct Column {
    ranges: [Range<i64>; 2],
    /// The origin of the first patch along x and y.
    origin: [i64; 2],
    lines: Lines,
    /// The next plane.
    z: i64,
    /// The next row of the plane.
    row: usize,
}

/// A slab of planes.
#[derive(Clone, Debug, Default)]
struct Slab {
    planes: Range<i64>,
    cells: Cells,
    /// The shears of each patch, once they are needed.
    shears: Vec<Option<[PatchShears; 3]>>,
}

/// The values that the points of a batch have in common.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Key {
    patch: usize,
    /// How they are tested after the warp.
    state: u16,
}

impl Walk {
    /// The walk over the points of a scope at places of a box, from a place on.
    pub(super) fn new(
        scope: Arc<Scope>,
        ranges: &[Range<i64>; 3],
        start: Option<[i64; 3]>,
        wants_ids: bool,
    ) -> Self {
        let mut ranges = scope.clip(ranges);
        if ranges.iter().any(Range::is_empty) {
            ranges = [0..0, 0..0, 0..0];
        }
        let first = match start {
            Some([x, y, _]) => [x >> COLUMN_BITS, y >> COLUMN_BITS],
            None => [0, 1].map(|axis| columns(&ranges[axis]).start),
        };
        let mut walk = Self {
            next: first,
            ranges,
            start,
            wants_ids,
            backend: Backend::best(),
            column: Column::default(),
            slab: Slab::default(),
            plane: None,
            templates: Templates::default(),
            pending: Batch::default(),
            key: Key::default(),
            room: [Vec::new(), Vec::new()],
            gaps: Vec::new(),
            row_start: 0,
            scope,
        };
        // No planes are left of a column that there is not.
        walk.column.z = i64::MAX;
        walk
    }

    /// Fills a batch with the next points, at least one. Returns false if there are none.
    pub(super) fn next(&mut self, out: &mut Batch) -> bool {
        loop {
            let is_complete = match self.plane {
                Some(plane) => self.fill(plane),
                None => {
                    let z = self.column.z;
                    let stays = self.slab.planes.contains(&z) && z < self.ranges[2].end;
                    let is_complete = !stays && !self.pending.is_empty();
                    if !is_complete && !self.next_plane() {
                        return false;
                    }
                    is_complete
                }
            };
            if is_complete {
                self.finish(out);
                if !out.is_empty() {
                    return true;
                }
            }
        }
    }

    /// Goes to the next plane, or to the next column. Returns false at the end.
    fn next_plane(&mut self) -> bool {
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
        self.templates.clear(map.intervals());
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
        self.column.lines.list(&self.scope.lattice, ranges.clone());
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
        let patches = (y.end - 1 - origin_y) >> PATCH_BITS;
        self.slab.shears.clear();
        self.slab.shears.resize(patches as usize + 1, None);
        self.slab.planes = first..first + (1 << CELL_BITS);
    }

    /// Adds rows of the plane to the pending batch. Returns true once that is complete, and leaves the plane at its end.
    fn fill(&mut self, plane: Plane) -> bool {
        while let Some(&row) = self.column.lines.y.get(self.column.row) {
            // The sum of x and y must have the parity that the plane demands, and that of x and z the row's.
            if row.others ^ row.own != plane.others ^ plane.own {
                self.column.row += 1;
                continue;
            }
            let offset = row.at - self.column.origin[1];
            let key = self.key_of(offset);
            if key.state == OUT {
                self.column.row += 1;
                continue;
            }
            if key != self.key && !self.pending.is_empty() {
                return true;
            }
            if self.pending.is_empty() {
                self.key = key;
                self.pending.restart(self.origin(key.patch));
            }
            self.add(plane, row);
            self.pad();
            self.column.row += 1;
            if self.pending.len() >= LONG {
                return true;
            }
        }
        self.plane = None;
        false
    }

    /// The patch of a row and the state of its points: of those of a warped row together.
    fn key_of(&self, offset: i64) -> Key {
        let runs = self.slab.cells.row((offset >> CELL_BITS) as usize);
        let is_warped = self.scope.lattice.shears.is_some();
        let mut state = OUT;
        for run in runs.iter().filter(|run| run.state != OUT) {
            state = match state {
                _ if !is_warped => IN,
                OUT | IN => run.state,
                same if same == run.state || run.state == IN => same,
                _ => TEST,
            };
        }
        Key {
            patch: (offset >> PATCH_BITS) as usize,
            state,
        }
    }

    /// The origin of a patch of the slab.
    fn origin(&self, patch: usize) -> [i64; 3] {
        let [x, y] = self.column.origin;
        let z = self.slab.planes.start;
        [x, y + ((patch as i64) << PATCH_BITS), z]
    }

    /// Adds the points of a row to the pending batch.
    fn add(&mut self, plane: Plane, row: Row) {
        let scope = &*self.scope;
        let origin = self.pending.origin;
        let key = (row.own, row.block as usize);
        let lines = &self.column.lines;
        let is_box = scope.is_box();
        let place = (origin, is_box.then_some(&scope.bounds));
        let mut points = self.templates.get(&scope.lattice, lines, plane, place, key);
        let columns = &self.templates.columns;
        if let Some(start) = self.start
            && [start[1], start[2]] == [row.at, plane.at]
        {
            let first = (start[0] - origin[0]) as i32;
            points.start += columns[points.clone()].partition_point(|&column| column < first);
        }
        if is_box {
            self.add_of_box(row, plane, points);
            return;
        }
        let below = |points: &Range<usize>, end: i32| {
            let part = &columns[points.clone()];
            if part.last().is_some_and(|&last| last < end) {
                part.len()
            } else {
                part.partition_point(|&column| column < end)
            }
        };
        let offset = row.at - self.column.origin[1];
        let [y, z] = [row.at - origin[1], plane.at - origin[2]].map(|v| v as i32);
        for run in self.slab.cells.row((offset >> CELL_BITS) as usize) {
            let length = below(&points, run.end);
            let part = points.start..points.start + length;
            points.start = part.end;
            if run.state == OUT || part.is_empty() {
                continue;
            }
            let pending = &mut self.pending;
            let lift = y << FRACTION_BITS;
            if run.state == IN {
                let [xs, ys, zs] = &mut pending.places;
                xs.extend_from_slice(&self.templates.places[0][part.clone()]);
                ys.extend(
                    self.templates.places[1][part.clone()]
                        .iter()
                        .map(|dy| dy + lift),
                );
                zs.extend_from_slice(&self.templates.places[2][part.clone()]);
                if self.wants_ids {
                    pending.ids.extend(columns[part].iter().map(|&x| [x, y, z]));
                }
                continue;
            }
            let is_warped = scope.lattice.shears.is_some();
            let volume = match is_warped {
                true => None,
                false => self.slab.cells.volume(scope, run.state),
            };
            let ends = relative(&scope.before, origin);
            for i in part {
                let place = [0, 1, 2].map(|axis| self.templates.places[axis][i]);
                let place = [place[0], place[1] + lift, place[2]];
                let is_inside = (0..3).all(|axis| ends[axis].contains(&place[axis]));
                if !is_inside {
                    continue;
                }
                if let Some(volume) = volume {
                    let at = world(scope, origin, place);
                    if !volume.contains(at) {
                        continue;
                    }
                }
                for (list, place) in pending.places.iter_mut().zip(place) {
                    list.push(place);
                }
                if self.wants_ids {
                    pending.ids.push([columns[i], y, z]);
                }
            }
        }
    }

    /// Adds points of a row of a box without warp, which lie between its bounds along x and z.
    fn add_of_box(&mut self, row: Row, plane: Plane, points: Range<usize>) {
        let scope = &*self.scope;
        let pending = &mut self.pending;
        let origin = pending.origin;
        let [y, z] = [row.at - origin[1], plane.at - origin[2]].map(|v| v as i32);
        let lift = y << FRACTION_BITS;
        let [all_x, all_y, all_z] = &self.templates.places;
        let columns = &self.templates.columns;
        let [least, most] = scope.lattice.turned.reach[1].map(i64::from);
        let (at, bounds) = (fixed(row.at), &scope.bounds[1]);
        let [xs, ys, zs] = &mut pending.places;
        if bounds.start <= at + least && at + most < bounds.end {
            xs.extend_from_slice(&all_x[points.clone()]);
            ys.extend(all_y[points.clone()].iter().map(|dy| dy + lift));
            zs.extend_from_slice(&all_z[points.clone()]);
            if self.wants_ids {
                let ids = columns[points].iter().map(|&x| [x, y, z]);
                pending.ids.extend(ids);
            }
            return;
        }
        for i in points {
            if bounds.contains(&(at + i64::from(all_y[i]))) {
                xs.push(all_x[i]);
                ys.push(all_y[i] + lift);
                zs.push(all_z[i]);
                if self.wants_ids {
                    pending.ids.push([columns[i], y, z]);
                }
            }
        }
    }
}

/// Fixed-point bounds relative to an origin, cut to the reach of offsets.
fn relative(bounds: &[Range<i64>; 3], origin: [i64; 3]) -> [Range<i32>; 3] {
    [0, 1, 2].map(|axis| {
        let from = fixed(origin[axis]);
        let place = |v: i64| (v - from).clamp(i32::MIN.into(), i32::MAX.into()) as i32;
        place(bounds[axis].start)..place(bounds[axis].end)
    })
}

/// The world coordinates of an offset from an origin.
fn world(scope: &Scope, origin: [i64; 3], place: [i32; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        scope
            .lattice
            .world(fixed(origin[axis]) + i64::from(place[axis]))
    })
}
