//! The end of a batch: its points go through the warp, and those outside are left out.

use super::{PATCH_BITS, Walk, relative, world};
use crate::{
    sample::space::warp_lists,
    space::{batch::Batch, cells::IN, scope::common, warp::PLANES},
    table::FRACTION_BITS,
};

/// The points that are warped together.
const VECTOR: usize = 32;
/// Rows of less points share vectors.
const SHORT: usize = 24;

impl Walk {
    /// Fills the last vector of a row that will be warped, so that the points of a vector are near each other.
    pub(super) fn pad(&mut self) {
        if self.scope.lattice.shears.is_none() {
            return;
        }
        let length = self.pending.len();
        let padded = length.next_multiple_of(VECTOR);
        // Short rows are near each other.
        if padded == length || length - self.row_start < SHORT {
            return;
        }
        for list in &mut self.pending.places {
            let last = list.last().copied().unwrap_or(0);
            list.resize(padded, last);
        }
        if self.wants_ids {
            let last = self.pending.ids.last().copied().unwrap_or([0; 3]);
            self.pending.ids.resize(padded, last);
        }
        self.gaps.push(length..padded);
        self.row_start = padded;
    }

    /// Moves the pending points to `out`, through the warp if there is one, and keeps those inside.
    pub(super) fn finish(&mut self, out: &mut Batch) {
        core::mem::swap(&mut self.pending, out);
        let origin = out.origin;
        self.pending.restart(origin);
        self.row_start = 0;
        if self.scope.lattice.shears.is_none() || out.is_empty() {
            return;
        }
        self.warp(out);
        if self.key.state == IN {
            return;
        }
        let scope = &self.scope;
        let ends = relative(&scope.bounds, origin);
        let is_between = |place: [i32; 3]| (0..3).all(|axis| ends[axis].contains(&place[axis]));
        match self.slab.cells.volume(scope, self.key.state) {
            None => out.retain_between(&ends),
            Some(volume) => out
                .retain(|place| is_between(place) && volume.contains(world(scope, origin, place))),
        }
    }

    /// Warps the points of a batch of the current patch.
    fn warp(&mut self, out: &mut Batch) {
        let Some(shears) = &self.scope.lattice.shears else {
            return;
        };
        let origin = out.origin;
        let column = &self.column;
        let patch = self.slab.shears[self.key.patch].get_or_insert_with(|| {
            let height = origin[1]..origin[1] + (1 << PATCH_BITS);
            let planes = common(&self.slab.planes, &self.ranges[2]);
            let sides = [
                column.ranges[0].clone(),
                common(&height, &column.ranges[1]),
                planes,
            ];
            let ranges = [0, 1, 2].map(|axis| {
                let [least, most] = self.scope.lattice.turned.reach[axis];
                let side = &sides[axis];
                let place = |v: i64| ((v - origin[axis]) << FRACTION_BITS) as i32;
                [place(side.start) + least, place(side.end - 1) + most]
            });
            shears.patch(origin, ranges)
        });
        let length = out.len();
        let padded = length.next_multiple_of(32);
        for list in out.places.iter_mut().chain(&mut self.room) {
            let last = list.last().copied().unwrap_or(0);
            list.resize(padded, last);
        }
        for (shears, [a, b]) in patch.iter().zip(PLANES) {
            warp_lists(
                self.backend,
                shears,
                [&out.places[a], &out.places[b]],
                &mut self.room,
            );
            core::mem::swap(&mut out.places[a], &mut self.room[0]);
            core::mem::swap(&mut out.places[b], &mut self.room[1]);
        }
        for list in &mut out.places {
            list.truncate(length);
        }
        out.close(&self.gaps);
        self.gaps.clear();
    }
}
