//! The walk over the points of a scope, in order.
//!
//! `course` goes through the rows. Where there is no warp and no other set to keep clear of, `rows` writes them as items.
//! Everything else takes batches, in which points can still move and be left out; `finish` warps and tests these, in groups.
//! `few` makes the points of a small scope at once.

mod course;
mod few;
mod finish;
mod rows;

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use course::{Course, PATCH_BITS, cover};

use super::{
    Batch,
    cells::{IN, OUT, Run, TEST},
    columns::Row,
    lattice::fixed,
    scope::Scope,
    template::{Plane, Templates},
};
use crate::{
    kernel::{Backend, Extents, SpaceShears, lift_picked},
    table::FRACTION_BITS,
};
pub(super) use few::few;
pub(super) use rows::Rows;

/// A batch ends with the row that makes it as long.
const LONG: usize = 512;

/// A walk over the points of a scope.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    course: Course,
    wants_ids: bool,
    pub(super) backend: Backend,
    templates: Templates<i32>,
    /// The points of the rows so far, before the warp if there is one.
    pending: Batch,
    /// The values that these have in common.
    key: Key,
    /// The shears of each patch of a slab, once they are needed, and the number of that slab.
    shears: (u64, Vec<Option<SpaceShears>>),
    /// The extents of the groups of points that will be warped.
    extents: Vec<Extents>,
    /// The parts of the batch that are no points.
    gaps: Vec<Range<usize>>,
    /// Where the rows begin that no gap follows.
    row_start: usize,
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
        Self {
            course: Course::new(scope.clone(), ranges, start),
            wants_ids: wants_ids || scope.lattice.is_sifted(),
            backend: Backend::best(),
            templates: Templates::default(),
            pending: Batch::default(),
            key: Key::default(),
            shears: (0, Vec::new()),
            extents: Vec::new(),
            gaps: Vec::new(),
            row_start: 0,
        }
    }

    pub(super) fn scope(&self) -> &Scope {
        &self.course.scope
    }

    /// Fills a batch with the next points, at least one. Returns false if there are none.
    pub(super) fn next(&mut self, out: &mut Batch) -> bool {
        loop {
            let is_complete = match self.course.plane {
                Some(plane) => self.fill(plane),
                None => {
                    let is_complete = !self.course.stays_in_slab() && !self.pending.is_empty();
                    if !is_complete {
                        if !self.course.next_plane() {
                            return false;
                        }
                        let map = self.course.scope.lattice.table.map();
                        let lines = &self.course.column.lines;
                        self.templates.begin_plane(lines, map.intervals());
                    }
                    is_complete
                }
            };
            if is_complete {
                self.finish(out);
                self.course.scope.lattice.sift(out);
                if !out.is_empty() {
                    return true;
                }
            }
        }
    }

    /// Adds rows of the plane to the pending batch. Returns true once that is complete, and leaves the plane at its end.
    fn fill(&mut self, plane: Plane) -> bool {
        while let Some((number, row)) = self.course.row(plane) {
            let key = self.key_of(row);
            if key.state == OUT {
                self.course.pass(number);
                continue;
            }
            if key != self.key && !self.pending.is_empty() {
                return true;
            }
            if self.pending.is_empty() {
                self.key = key;
                self.pending.restart(self.course.origin(key.patch));
            }
            self.add(plane, row);
            self.pad();
            self.course.pass(number);
            if self.pending.len() >= LONG {
                return true;
            }
        }
        self.course.plane = None;
        false
    }

    /// The patch of a row and the state of its points: of those of a warped row together.
    fn key_of(&self, row: Row) -> Key {
        let is_warped = self.course.scope.lattice.shears.is_some();
        let mut state = OUT;
        for run in self.course.runs(row).iter().filter(|run| run.state != OUT) {
            state = match state {
                _ if !is_warped => IN,
                OUT | IN => run.state,
                same if same == run.state || run.state == IN => same,
                _ => TEST,
            };
        }
        Key {
            patch: self.course.patch(row),
            state,
        }
    }

    /// Adds the points of a row to the pending batch.
    fn add(&mut self, plane: Plane, row: Row) {
        let course = &self.course;
        let scope = &*course.scope;
        let pending = &mut self.pending;
        let origin = pending.origin;
        let templates = &mut self.templates;
        let key = (row.own, row.block as usize);
        let lattice = &scope.lattice;
        let convert = |_, lift: i32, offsets: &[i32], places: &mut Vec<i32>| {
            places.extend(offsets.iter().map(|offset| lift + offset));
        };
        let how = (self.backend, &convert);
        let mut points = templates.get(
            (lattice, &course.column.lines),
            plane,
            (origin, None),
            key,
            how,
        );
        if let Some(first) = course.first(plane, row, origin[0]) {
            points.start += templates.columns[points.clone()].partition_point(|&at| at < first);
        }
        let [y, z] = [row.at - origin[1], plane.at - origin[2]].map(|v| v as i32);
        let lift = y << FRACTION_BITS;
        let ys = lattice.components(1, plane.block, row.block as usize);
        let heights = templates.heights(row.block as usize);
        let mut runs = course.runs(row);
        let whole = [Run {
            end: i32::MAX,
            state: TEST,
        }];
        // The points of a warped row are tested together.
        if scope.lattice.shears.is_some() && runs.iter().all(|run| run.state != OUT) {
            runs = &whole;
        }
        for run in runs {
            let part = templates.before(&mut points, run.end);
            if run.state == OUT || part.is_empty() {
                continue;
            }
            let blocks = &templates.blocks[part.clone()];
            let needs_test = run.state != IN && scope.lattice.shears.is_none();
            let start = pending.len();
            let [to_x, to_y, to_z] = &mut pending.places;
            to_x.extend_from_slice(&templates.places[part.clone()]);
            for (to, lift, picks) in [(to_y, lift, ys), (to_z, 0, heights)] {
                to.resize(start + blocks.len(), 0);
                lift_picked(self.backend, lift, blocks, picks, &mut to[start..]);
            }
            let columns = &templates.columns[part.clone()];
            if scope.lattice.shears.is_some() {
                cover(&mut self.extents, start, columns, [y, z]);
            }
            if self.wants_ids {
                pending
                    .ids
                    .extend(columns.iter().map(|&x| [x >> FRACTION_BITS, y, z]));
            }
            if needs_test {
                let volume = course.slab.cells.volume(scope, run.state);
                let ends = relative(&scope.bounds, origin);
                pending.retain_from(start, |place| {
                    (0..3).all(|axis| ends[axis].contains(&place[axis]))
                        && volume.is_none_or(|volume| volume.contains(world(scope, origin, place)))
                });
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
    let place = |axis| fixed(origin[axis]) + i64::from(place[axis]);
    scope.lattice.at([0, 1, 2].map(place))
}
