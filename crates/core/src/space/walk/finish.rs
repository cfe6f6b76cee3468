//! The end of a batch: its points go through the warp, and those outside are left out.

use alloc::vec::Vec;

use super::{PATCH_BITS, Walk, relative, world};
use crate::{
    kernel::{GROUP, PLANES, compiled, retain_parts, warp_groups, warp_lists},
    space::{Batch, cells::IN, scope::common},
    table::FRACTION_BITS,
};

/// Rows of less points share groups.
const SHORT: usize = 16;

impl Walk {
    /// Fills the last group of a row that will be warped, so that the points of a group are near each other.
    pub(super) fn pad(&mut self) {
        if self.course.scope.lattice.shears.is_none() {
            return;
        }
        let length = self.pending.len();
        let padded = length.next_multiple_of(GROUP);
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
        if self.course.scope.lattice.shears.is_none() || out.is_empty() {
            return;
        }
        let length = out.len();
        self.warp(out);
        let scope = &self.course.scope;
        let is_tested = self.key.state != IN;
        let ends = relative(&scope.bounds, origin);
        let starts = [0].into_iter().chain(self.gaps.iter().map(|gap| gap.end));
        let last = self.gaps.iter().map(|gap| gap.start).chain([length]);
        let parts = starts.zip(last).map(|(start, end)| start..end);
        let lists = out.places.each_mut().map(Vec::as_mut_slice);
        let kept = match (out.ids.is_empty(), is_tested) {
            (true, true) => retain_parts(self.backend, lists, parts, &ends),
            (true, false) => retain_parts(self.backend, lists, parts, &[]),
            (false, _) => None,
        };
        match kept {
            Some(kept) => out.truncate(kept),
            None => {
                out.truncate(length);
                out.close(&self.gaps);
                if is_tested {
                    compiled(self.backend, || out.retain_between(&ends));
                }
            }
        }
        self.gaps.clear();
        if is_tested && let Some(volume) = self.course.slab.cells.volume(scope, self.key.state) {
            out.retain(|place| volume.contains(world(scope, origin, place)));
        }
    }

    /// Warps the points of a batch of the current patch, and leaves them padded to whole groups.
    fn warp(&mut self, out: &mut Batch) {
        let course = &self.course;
        let lattice = &course.scope.lattice;
        let Some(shears) = &lattice.shears else {
            return;
        };
        let origin = out.origin;
        let (number, patches) = &mut self.shears;
        if *number != course.slab.number {
            *number = course.slab.number;
            patches.clear();
            patches.resize(course.patches(), None);
        }
        let patch = patches[self.key.patch].get_or_insert_with(|| {
            let height = origin[1]..origin[1] + (1 << PATCH_BITS);
            let sides = [
                course.column.ranges[0].clone(),
                common(&height, &course.column.ranges[1]),
                common(&course.slab.planes, &course.ranges[2]),
            ];
            let ranges = [0, 1, 2].map(|axis| {
                let [least, most] = lattice.turned.reach[axis];
                let side = &sides[axis];
                let place = |v: i64| ((v - origin[axis]) << FRACTION_BITS) as i32;
                [place(side.start) + least, place(side.end - 1) + most]
            });
            shears.patch(origin, ranges, lattice.turned.reach)
        });
        out.pad(GROUP);
        let places = out.places.each_mut().map(Vec::as_mut_slice);
        let is_warped = warp_groups(self.backend, patch, &self.extents, places);
        self.extents.clear();
        for (shears, [a, b]) in patch.planes.iter().zip(PLANES) {
            if is_warped {
                break;
            }
            if let Ok(places) = out.places.get_disjoint_mut([a, b]) {
                warp_lists(self.backend, shears, places.map(Vec::as_mut_slice));
            }
        }
    }
}
