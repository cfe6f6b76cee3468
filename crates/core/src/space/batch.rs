//! Batches: the points of some rows, as offsets from an origin.

use alloc::vec::Vec;
use core::ops::Range;

/// Points as fixed-point offsets from a lattice address, axis by axis.
#[derive(Clone, Debug, Default)]
pub struct Batch {
    /// The lattice address that offsets are relative to.
    pub(super) origin: [i64; 3],
    pub(super) places: [Vec<i32>; 3],
    /// The addresses of the points relative to the origin, if they are wanted.
    pub(super) ids: Vec<[i32; 3]>,
}

impl Batch {
    pub(super) fn len(&self) -> usize {
        self.places[0].len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.places[0].is_empty()
    }

    /// Removes all points and sets the origin of the next.
    pub(super) fn restart(&mut self, origin: [i64; 3]) {
        self.origin = origin;
        self.places.iter_mut().for_each(Vec::clear);
        self.ids.clear();
    }

    /// The lattice address of the point at a position, if the batch has it.
    pub(super) fn address(&self, point: usize) -> Option<[i64; 3]> {
        let id = self.ids.get(point)?;
        Some([0, 1, 2].map(|axis| self.origin[axis] + i64::from(id[axis])))
    }

    /// Removes the points of some ranges, which ascend.
    pub(super) fn close(&mut self, gaps: &[Range<usize>]) {
        let Some(first) = gaps.first() else {
            return;
        };
        let mut to = first.start;
        let ends = gaps.iter().skip(1).map(|gap| gap.start).chain([self.len()]);
        for (gap, end) in gaps.iter().zip(ends) {
            for list in &mut self.places {
                list.copy_within(gap.end..end, to);
            }
            if !self.ids.is_empty() {
                self.ids.copy_within(gap.end..end, to);
            }
            to += end - gap.end;
        }
        self.truncate(to);
    }

    /// Removes all points from a position on.
    pub(super) fn truncate(&mut self, length: usize) {
        self.places
            .iter_mut()
            .for_each(|list| list.truncate(length));
        self.ids.truncate(length);
    }

    /// Keeps the points between bounds.
    #[inline(always)]
    pub(super) fn retain_between(&mut self, ends: &[Range<i32>; 3]) {
        /// The number of points that are looked at together.
        const PART: usize = 16;
        let length = self.len();
        let mut kept = 0;
        let mut from = 0;
        while from < length {
            let part = from..length.min(from + PART);
            let mut is_inside = true;
            for (list, ends) in self.places.iter().zip(ends) {
                for &v in &list[part.clone()] {
                    is_inside &= (ends.start <= v) & (v < ends.end);
                }
            }
            if is_inside {
                if kept != from {
                    for list in &mut self.places {
                        list.copy_within(part.clone(), kept);
                    }
                    if !self.ids.is_empty() {
                        self.ids.copy_within(part.clone(), kept);
                    }
                }
                kept += part.len();
            } else {
                for i in part.clone() {
                    let place = [0, 1, 2].map(|axis| self.places[axis][i]);
                    for (list, v) in self.places.iter_mut().zip(place) {
                        list[kept] = v;
                    }
                    if !self.ids.is_empty() {
                        self.ids[kept] = self.ids[i];
                    }
                    kept += usize::from((0..3).all(|axis| ends[axis].contains(&place[axis])));
                }
            }
            from = part.end;
        }
        self.truncate(kept);
    }

    /// Keeps the points for whose place the test holds.
    pub(super) fn retain(&mut self, test: impl FnMut([i32; 3]) -> bool) {
        self.retain_from(0, test);
    }

    /// Keeps the points from a position on for whose place the test holds, and those before it.
    pub(super) fn retain_from(&mut self, start: usize, mut test: impl FnMut([i32; 3]) -> bool) {
        let [x, y, z] = &mut self.places;
        let has_ids = !self.ids.is_empty();
        let mut kept = start;
        for i in start..x.len() {
            let place = [x[i], y[i], z[i]];
            [x[kept], y[kept], z[kept]] = place;
            if has_ids {
                self.ids[kept] = self.ids[i];
            }
            kept += usize::from(test(place));
        }
        self.truncate(kept);
    }
}
