//! Batches: the points of some rows, as offsets from an origin.

use alloc::vec::Vec;
use core::{array::from_fn, ops::Range};

use crate::table::FRACTION_BITS;

/// An address relative to an origin.
pub(crate) trait Offset<const D: usize>: Copy {
    /// The distance from the origin, in lattice units.
    fn offset(self) -> [i64; D];
}

/// A column and a row of up to 16 bits, the row in the upper ones.
impl Offset<2> for i32 {
    #[inline(always)]
    fn offset(self) -> [i64; 2] {
        [self & 0xffff, self >> 16].map(i64::from)
    }
}

impl<const D: usize> Offset<D> for [i32; D] {
    fn offset(self) -> [i64; D] {
        self.map(i64::from)
    }
}

/// Points as fixed-point offsets from a lattice address, axis by axis.
#[derive(Clone, Debug)]
pub struct Batch<const D: usize, Id> {
    /// The lattice address that offsets are relative to.
    pub(crate) origin: [i64; D],
    pub(crate) places: [Vec<i32>; D],
    /// The addresses of the points relative to the origin, if they are wanted.
    pub(crate) ids: Vec<Id>,
}

impl<const D: usize, Id> Default for Batch<D, Id> {
    fn default() -> Self {
        Self {
            origin: [0; D],
            places: from_fn(|_| Vec::new()),
            ids: Vec::new(),
        }
    }
}

impl<const D: usize, Id: Offset<D>> Batch<D, Id> {
    pub(crate) fn len(&self) -> usize {
        self.places[0].len()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.places[0].is_empty()
    }

    /// The memory of the lists.
    pub(crate) fn bytes(&self) -> usize {
        let places = self.places.iter().map(|list| 4 * list.capacity());
        places.sum::<usize>() + size_of::<Id>() * self.ids.capacity()
    }

    /// Removes all points and sets the origin of the next.
    pub(crate) fn restart(&mut self, origin: [i64; D]) {
        self.origin = origin;
        self.truncate(0);
    }

    /// The lattice address of the point at a position, if the batch has it.
    pub(crate) fn address(&self, point: usize) -> Option<[i64; D]> {
        let id = self.ids.get(point)?.offset();
        Some(from_fn(|axis| self.origin[axis] + id[axis]))
    }

    /// The fixed-point place of the point at a position.
    #[inline(always)]
    pub(crate) fn place(&self, point: usize) -> [i64; D] {
        from_fn(|axis| (self.origin[axis] << FRACTION_BITS) + i64::from(self.places[axis][point]))
    }

    /// Moves all points of another batch after those of this one, whatever its origin.
    pub(crate) fn append(&mut self, other: &mut Self) {
        if self.is_empty() {
            core::mem::swap(&mut self.places, &mut other.places);
            core::mem::swap(&mut self.ids, &mut other.ids);
        }
        for (list, other) in self.places.iter_mut().zip(&mut other.places) {
            list.append(other);
        }
        self.ids.append(&mut other.ids);
    }

    /// Repeats the last place until the number of places is a multiple of `whole`, so that vectors are full.
    pub(crate) fn pad(&mut self, whole: usize) {
        self.places.iter_mut().for_each(|list| pad(list, whole));
    }

    /// Removes the points of some ranges, which ascend.
    pub(crate) fn close(&mut self, gaps: &[Range<usize>]) {
        let Some(first) = gaps.first() else {
            return;
        };
        let mut to = first.start;
        let ends = gaps.iter().skip(1).map(|gap| gap.start).chain([self.len()]);
        for (gap, end) in gaps.iter().zip(ends) {
            to = self.shift(gap.end..end, to);
        }
        self.truncate(to);
    }

    /// Removes all points from a position on.
    pub(crate) fn truncate(&mut self, length: usize) {
        self.places
            .iter_mut()
            .for_each(|list| list.truncate(length));
        self.ids.truncate(length);
    }

    /// Moves points to an earlier position. Returns the position after them.
    #[inline(always)]
    fn shift(&mut self, points: Range<usize>, to: usize) -> usize {
        if points.start != to {
            for list in &mut self.places {
                list.copy_within(points.clone(), to);
            }
            if !self.ids.is_empty() {
                self.ids.copy_within(points.clone(), to);
            }
        }
        to + points.len()
    }

    /// Keeps the points between bounds.
    #[inline(always)]
    pub(crate) fn retain_between(&mut self, ends: &[Range<i32>; D]) {
        /// The number of points that are looked at together.
        const PART: usize = 16;
        let (length, mut kept, mut from) = (self.len(), 0, 0);
        while from < length {
            let part = from..length.min(from + PART);
            let mut is_inside = true;
            for (list, ends) in self.places.iter().zip(ends) {
                for &v in &list[part.clone()] {
                    is_inside &= (ends.start <= v) & (v < ends.end);
                }
            }
            from = part.end;
            kept = match is_inside {
                true => self.shift(part, kept),
                false => self.sift(part, kept, |place| {
                    (0..D).all(|axis| ends[axis].contains(&place[axis]))
                }),
            };
        }
        self.truncate(kept);
    }

    /// Moves those points that a test of their place leaves to an earlier position. Returns the position after them.
    #[inline(always)]
    fn sift(
        &mut self,
        points: Range<usize>,
        mut to: usize,
        mut test: impl FnMut([i32; D]) -> bool,
    ) -> usize {
        let Self { places, ids, .. } = self;
        for i in points {
            let place = from_fn(|axis| places[axis][i]);
            for (list, v) in places.iter_mut().zip(place) {
                list[to] = v;
            }
            if !ids.is_empty() {
                ids[to] = ids[i];
            }
            to += usize::from(test(place));
        }
        to
    }

    /// Keeps the points for whose place the test holds.
    pub(crate) fn retain(&mut self, test: impl FnMut([i32; D]) -> bool) {
        self.retain_from(0, test);
    }

    /// Keeps the points from a position on for whose place the test holds, and those before it.
    pub(crate) fn retain_from(&mut self, start: usize, test: impl FnMut([i32; D]) -> bool) {
        let kept = self.sift(start..self.len(), start, test);
        self.truncate(kept);
    }
}

/// Repeats the last number until there is a multiple of `whole`.
pub(crate) fn pad(list: &mut Vec<i32>, whole: usize) {
    let last = list.last().copied().unwrap_or(0);
    list.resize(list.len().next_multiple_of(whole), last);
}
