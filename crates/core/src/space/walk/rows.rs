//! Rows without warp, written as items of a format.
//!
//! A place along x is converted once for all rows of a template, places along y and z once for each interval: a point only
//! picks its three numbers.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use super::{course::Course, relative, world};
use crate::{
    kernel::Backend,
    space::{
        cells::{IN, OUT},
        columns::Row,
        format::{Format, Picks, convert},
        scope::Scope,
        template::{Plane, Templates},
    },
    table::FRACTION_BITS,
};

/// A walk over rows that are written as items.
#[derive(Clone, Debug)]
pub(in crate::space) struct Rows<F: Format> {
    course: Course,
    pub(in crate::space) backend: Backend,
    templates: Templates<F::Part>,
    /// How offsets from the origin of a patch become places.
    axes: Option<[F::Axis; 3]>,
    /// The number of the slab, from 1 on, and the patch.
    axes_of: (u64, usize),
    /// The places along y of the points of a row, by interval, and whether they are inside.
    across: Vec<F::Part>,
    inside: Vec<bool>,
    /// Whether the scope is a box.
    is_box: bool,
    /// The rows and the planes whose points lie within its bounds along y and z whatever their vectors are.
    within: [Range<i64>; 2],
    /// The items of a row of which only some were taken.
    pending: Vec<F::Item>,
    taken: usize,
}

/// A part of a row.
struct Part {
    plane: Plane,
    row: Row,
    origin: [i64; 3],
    points: Range<usize>,
}

impl<F: Format> Rows<F> {
    /// The walk over the points of a scope without warp, which are clear of nothing, from a place on.
    pub(in crate::space) fn new(scope: Arc<Scope>, start: Option<[i64; 3]>) -> Self {
        let ranges = scope.all.clone();
        Self {
            course: Course::new(scope.clone(), &ranges, start),
            backend: Backend::best(),
            templates: Templates::default(),
            axes: None,
            axes_of: (0, 0),
            across: Vec::new(),
            inside: Vec::new(),
            is_box: scope.is_box(),
            within: [1, 2].map(|axis| within(&scope, axis)),
            pending: Vec::new(),
            taken: 0,
        }
    }

    /// Fills a slice with the next items. Returns their number, which is less than the slice holds only at the end.
    pub(in crate::space) fn fill(&mut self, out: &mut [F::Item]) -> usize {
        let mut filled = 0;
        while filled < out.len() {
            let room = &mut out[filled..];
            if let Some(rest) = self
                .pending
                .get(self.taken..)
                .filter(|rest| !rest.is_empty())
            {
                let number = rest.len().min(room.len());
                room[..number].copy_from_slice(&rest[..number]);
                self.taken += number;
                filled += number;
                continue;
            }
            let Some((plane, row)) = self.next_row() else {
                break;
            };
            let part = self.part(plane, row);
            let length = part.points.len();
            if length <= room.len() {
                filled += self.write(part, room);
            } else {
                self.write_pending(part);
            }
        }
        filled
    }

    /// The next item, if there is one and it has been made.
    pub(in crate::space) fn peek(&self) -> Option<&F::Item> {
        self.pending.get(self.taken)
    }

    /// Makes the next item, if there is one.
    pub(in crate::space) fn prepare(&mut self) {
        while self.peek().is_none() {
            let Some((plane, row)) = self.next_row() else {
                return;
            };
            let part = self.part(plane, row);
            self.write_pending(part);
        }
    }

    fn write_pending(&mut self, part: Part) {
        let mut pending = core::mem::take(&mut self.pending);
        pending.clear();
        pending.resize(part.points.len(), F::Item::default());
        let number = self.write(part, &mut pending);
        pending.truncate(number);
        (self.pending, self.taken) = (pending, 0);
    }

    /// Goes to the next row.
    fn next_row(&mut self) -> Option<(Plane, Row)> {
        loop {
            if let Some(plane) = self.course.plane {
                if let Some((number, row)) = self.course.row(plane) {
                    self.course.pass(number);
                    return Some((plane, row));
                }
                self.course.plane = None;
            }
            if !self.course.next_plane() {
                return None;
            }
            let map = self.course.scope.lattice.table.map();
            let lines = &self.course.column.lines;
            self.templates.begin_plane(lines, map.intervals());
        }
    }

    /// The points of a row.
    fn part(&mut self, plane: Plane, row: Row) -> Part {
        let (course, backend) = (&self.course, self.backend);
        let scope = &*course.scope;
        let origin = course.origin(course.patch(row));
        let key = (course.slab.number, course.patch(row));
        if self.axes_of != key {
            self.axes_of = key;
            self.axes = Some([0, 1, 2].map(|axis| F::axis(scope, axis, origin[axis])));
        }
        let axes = &self.axes;
        let add = |axis: usize, lift: i32, offsets: &[i32], places: &mut Vec<F::Part>| {
            let Some(axes) = axes else {
                return;
            };
            let start = places.len();
            places.resize(start + offsets.len(), F::Part::default());
            convert::<F>(backend, axes[axis], (lift, offsets), &mut places[start..]);
        };
        let bounds = self.is_box.then_some(&scope.bounds[0]);
        let (lines, key) = (&course.column.lines, (row.own, row.block as usize));
        let templates = &mut self.templates;
        let mut points = templates.get(
            (&scope.lattice, lines),
            plane,
            (origin, bounds),
            key,
            (backend, &add),
        );
        if let Some(first) = course.first(plane, row, origin[0]) {
            points.start += templates.columns[points.clone()].partition_point(|&at| at < first);
        }
        let ys = scope.lattice.components(1, plane.block, row.block as usize);
        let lift = ((row.at - origin[1]) << FRACTION_BITS) as i32;
        self.across.resize(ys.len(), F::Part::default());
        if let Some(axes) = axes {
            convert::<F>(backend, axes[1], (lift, ys), &mut self.across);
        }
        Part {
            plane,
            row,
            origin,
            points,
        }
    }

    /// Writes the points of a row that are inside. Returns their number; there is room for all.
    fn write(&mut self, part: Part, out: &mut [F::Item]) -> usize {
        let Self {
            course,
            templates,
            across,
            inside,
            within,
            ..
        } = self;
        let scope = &*course.scope;
        let Part {
            plane,
            row,
            origin,
            mut points,
        } = part;
        let picks = |points: Range<usize>| Picks {
            places: &templates.places[points.clone()],
            blocks: &templates.blocks[points.clone()],
            columns: &templates.columns[points],
            across: [across, templates.heights(row.block as usize)],
            address: [origin[0], row.at, plane.at],
        };
        if self.is_box {
            // Templates have been tested along x.
            if within[0].contains(&row.at) && within[1].contains(&plane.at) {
                let length = points.len();
                F::pick(self.backend, picks(points), &mut out[..length]);
                return length;
            }
            let [_, ys, zs] = scope.lattice.vectors(plane.block, row.block as usize);
            let [_, across, high] = relative(&scope.bounds, origin);
            let [y, z] =
                [row.at - origin[1], plane.at - origin[2]].map(|v| (v << FRACTION_BITS) as i32);
            let both = ys.iter().zip(zs);
            inside.clear();
            inside.extend(
                both.map(|(dy, dz)| across.contains(&(y + dy)) && high.contains(&(z + dz))),
            );
            return picks(points).write_inside::<F>(inside, out);
        }
        let [dx, dy, dz] = scope.lattice.vectors(plane.block, row.block as usize);
        let ends = relative(&scope.bounds, origin);
        let from = [row.at - origin[1], plane.at - origin[2]].map(|v| (v << FRACTION_BITS) as i32);
        let mut written = 0;
        for run in course.runs(row) {
            let part = templates.before(&mut points, run.end);
            if run.state == OUT || part.is_empty() {
                continue;
            }
            let room = &mut out[written..];
            if run.state == IN {
                let length = part.len();
                F::pick(self.backend, picks(part), &mut room[..length]);
                written += length;
                continue;
            }
            let volume = course.slab.cells.volume(scope, run.state);
            let is_inside = |i: usize| {
                let block = usize::from(templates.blocks[i]);
                let x = templates.columns[i];
                let place = [x + dx[block], from[0] + dy[block], from[1] + dz[block]];
                (0..3).all(|axis| ends[axis].contains(&place[axis]))
                    && volume.is_none_or(|volume| volume.contains(world(scope, origin, place)))
            };
            written += picks(part.clone()).write_some::<F>(room, |i| is_inside(part.start + i));
        }
        written
    }
}

/// The lattice coordinates whose points lie within the bounds along an axis whatever their vectors are.
fn within(scope: &Scope, axis: usize) -> Range<i64> {
    let [least, most] = scope.lattice.turned.reach[axis].map(i64::from);
    let bounds = &scope.bounds[axis];
    let from_on = |place: i64| -(-place >> FRACTION_BITS);
    from_on(bounds.start - least)..from_on(bounds.end - most)
}
