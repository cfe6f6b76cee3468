//! The warp of points in space: all shears of the three planes, for points in groups of successive ones of a row.
//!
//! A shear waits for the one before it, so four vectors take turns. The places of a group in the lattice and bounds of
//! everything else tell which cells its points can touch, so no point is looked at for that. Along a row only x goes
//! through many cells: six of the twelve shears do not depend on it, and have tables that all four vectors share.
//!
//! Those between bounds are then picked out of the lists.

use core::ops::Range;

use super::{
    Backend,
    backend::run_vectors,
    lanes::{Lanes, VectorLoop},
    quadratics::{Near, Quadratics, Tables, noise},
};
use crate::{
    table::FRACTION_BITS,
    warp::{CELL_BITS, PatchShears},
};

/// The number of points of a group.
pub(crate) const GROUP: usize = 16;
/// The vectors that take turns.
const TURNS: usize = 4;

/// The axes of each plane, in the order of application.
pub(crate) const PLANES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// The shears of the three planes for the points of a patch.
#[derive(Clone, Debug)]
pub(crate) struct SpaceShears {
    pub(crate) planes: [PatchShears; 3],
    /// By plane and direction, the least coordinate across of points whose lattice coordinates are 0.
    leads: [[i32; 4]; 3],
    /// The greatest difference of coordinates across of points at one address.
    width: i64,
}

/// The least and the greatest lattice coordinates of a group, relative to the patch's origin.
pub(crate) type Extents = [[i32; 2]; 3];

impl SpaceShears {
    /// The shears of some planes, for points that are displaced by some numbers of fixed-point units.
    pub(crate) fn new(planes: [PatchShears; 3], reach: [[i32; 2]; 3]) -> Self {
        let mut ranges = reach;
        let mut width = 0;
        let mut leads = [[0; 4]; 3];
        for ((shears, [a, b]), leads) in planes.iter().zip(PLANES).zip(&mut leads) {
            let more = |[a, b]: [i32; 2], [c, d]: [i32; 2]| [a + c, b + d];
            let opposite = |[a, b]: [i32; 2]| [-b, -a];
            let [along_b, along_a, rising, falling] = shears.bounds;
            let first = ranges[a];
            let second = more(ranges[b], along_b);
            let moved = more(first, along_a);
            let third = more(moved, opposite(second));
            let raised = [more(moved, rising), more(second, rising)];
            let fourth = more(raised[0], raised[1]);
            let across = [first, second, third, fourth];
            *leads = across.map(|[least, _]| least);
            for [least, most] in across {
                width = width.max(i64::from(most) - i64::from(least));
            }
            ranges[a] = more(raised[0], falling);
            ranges[b] = more(raised[1], opposite(falling));
        }
        Self {
            planes,
            leads,
            width,
        }
    }

    /// Whether the points of a group touch at most some number of cells in each direction.
    fn fits(&self, extents: &Extents, cells: usize) -> bool {
        let sides = extents.map(|[least, most]| i64::from(most) - i64::from(least));
        let both = PLANES.map(|[a, b]| sides[a] + sides[b]);
        let widest = both.into_iter().fold(0, i64::max);
        (widest << FRACTION_BITS) + self.width <= (cells as i64 - 1) << CELL_BITS
    }

    /// The first cell of a direction of a plane that the points of a group touch.
    #[inline(always)]
    fn cell(&self, plane: usize, direction: usize, extents: &Extents) -> i32 {
        let [a, b] = PLANES[plane].map(|axis| extents[axis]);
        let across = match direction {
            0 => a[0],
            1 => b[0],
            2 => a[0] - b[1],
            _ => a[0] + b[0],
        };
        ((across << FRACTION_BITS) + self.leads[plane][direction]) >> CELL_BITS
    }
}

/// Warps points: three lists of their coordinates, whole groups, whose extents are known. Returns false, and leaves them,
/// unless vectors can do it.
pub(crate) fn warp_groups(
    backend: Backend,
    shears: &SpaceShears,
    extents: &[Extents],
    places: [&mut [i32]; 3],
) -> bool {
    let mut groups = Groups {
        shears,
        extents,
        places,
    };
    run_vectors(backend, &mut groups) > 0
}

struct Groups<'a> {
    shears: &'a SpaceShears,
    extents: &'a [Extents],
    places: [&'a mut [i32]; 3],
}

impl VectorLoop for Groups<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let length = self.extents.len() * GROUP;
        let mut groups = self.extents.iter();
        if self.places.iter().any(|list| list.len() != length)
            || !GROUP.is_multiple_of(L::WIDTH)
            || !groups.all(|extents| self.shears.fits(extents, L::WINDOW))
        {
            return 0;
        }
        for start in (0..length).step_by(TURNS * L::WIDTH) {
            // Beyond the end, the last vector is done again.
            let starts = [0, 1, 2, 3].map(|k| (start + k * L::WIDTH).min(length - L::WIDTH));
            let extents = starts.map(|start| &self.extents[start / GROUP]);
            let mut rows = *extents[0];
            for extents in &extents[1..] {
                for (all, [least, most]) in rows.iter_mut().zip(extents.iter()) {
                    *all = [all[0].min(*least), all[1].max(*most)];
                }
            }
            // Of the directions that x has no part in.
            rows[0] = [0; 2];
            // SAFETY: the machine has the instructions, and the lists have a vector from all starts on.
            unsafe {
                if self.shears.fits(&rows, L::WINDOW) {
                    self.turns::<L, _>(starts, extents, [&rows]);
                } else {
                    self.turns::<L, _>(starts, extents, extents);
                }
            }
        }
        length
    }
}

impl Groups<'_> {
    /// Warps the vectors at some places, with the extents of each, and for shears that x has no part in with one of all or
    /// of each.
    ///
    /// # Safety
    /// The machine has the instructions of `L`, and the lists have a vector from each of `starts` on.
    #[inline(always)]
    unsafe fn turns<L: Lanes, const ROWS: usize>(
        &mut self,
        starts: [usize; TURNS],
        extents: [&Extents; TURNS],
        rows: [&Extents; ROWS],
    ) {
        // SAFETY: as the caller ensures.
        unsafe {
            let mut all = starts.map(|start| {
                let list = |axis: usize| self.places[axis].as_ptr().add(start);
                [0, 1, 2].map(|axis| L::load_ints(list(axis)))
            });
            for (plane, [a, b]) in PLANES.into_iter().enumerate() {
                let tables = |direction| Tables::new(&self.shears.planes[plane], direction);
                let tables = [tables(0), tables(1), tables(2), tables(3)];
                let shear = |direction: usize, k: usize| {
                    let has_x = match direction {
                        0 => a == 0,
                        1 => b == 0,
                        _ => a == 0 || b == 0,
                    };
                    let extents = if has_x { extents[k] } else { rows[k % ROWS] };
                    let cell = self.shears.cell(plane, direction, extents);
                    Near::<L>::new(tables[direction], cell)
                };
                for (k, at) in all.iter_mut().enumerate() {
                    at[b] = L::add_ints(at[b], noise(shear(0, k), at[a]));
                }
                for (k, at) in all.iter_mut().enumerate() {
                    at[a] = L::add_ints(at[a], noise(shear(1, k), at[b]));
                }
                for (k, at) in all.iter_mut().enumerate() {
                    let rising = noise(shear(2, k), L::sub_ints(at[a], at[b]));
                    at[a] = L::add_ints(at[a], rising);
                    at[b] = L::add_ints(at[b], rising);
                }
                for (k, at) in all.iter_mut().enumerate() {
                    let falling = noise(shear(3, k), L::add_ints(at[a], at[b]));
                    at[a] = L::add_ints(at[a], falling);
                    at[b] = L::sub_ints(at[b], falling);
                }
            }
            for (start, at) in starts.into_iter().zip(all) {
                for (list, v) in self.places.iter_mut().zip(at) {
                    L::store_ints(list.as_mut_ptr().add(start), v);
                }
            }
        }
    }
}

/// Keeps the points of some parts of three lists whose numbers in the first ones lie between bounds: moves them to the
/// front. Parts ascend and begin at multiples of 16, of which the length of the lists is one, too. Returns the number of
/// points kept, or `None`, and leaves the lists, unless vectors can do it.
pub(crate) fn retain_parts<const N: usize>(
    backend: Backend,
    lists: [&mut [i32]; 3],
    parts: impl Iterator<Item = Range<usize>> + Clone,
    ends: &[Range<i32>; N],
) -> Option<usize> {
    let mut retain = Retain {
        lists,
        parts,
        ends,
        kept: 0,
    };
    (run_vectors(backend, &mut retain) > 0).then_some(retain.kept)
}

struct Retain<'a, P, const N: usize> {
    lists: [&'a mut [i32]; 3],
    parts: P,
    ends: &'a [Range<i32>; N],
    kept: usize,
}

impl<P: Iterator<Item = Range<usize>> + Clone, const N: usize> VectorLoop for Retain<'_, P, N> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let length = self.lists[0].len();
        let is_whole = |list: &&mut [i32]| list.len() == length;
        if !L::HAS_COMPRESS || !length.is_multiple_of(L::WIDTH) || !self.lists.iter().all(is_whole)
        {
            return 0;
        }
        self.kept = 0;
        for part in self.parts.clone() {
            assert!(
                part.start.is_multiple_of(L::WIDTH)
                    && part.end <= length
                    && self.kept <= part.start
            );
            let whole = part.end - part.len() % L::WIDTH;
            // SAFETY: the machine has the instructions, the lists have a vector from each start on, and so from where
            // points are kept, which is not behind it.
            unsafe {
                self.keep::<L>(part.start..whole, u32::MAX >> (32 - L::WIDTH));
                self.keep::<L>(whole..part.end, (1 << (part.end - whole)) - 1);
            }
        }
        length
    }
}

impl<P, const N: usize> Retain<'_, P, N> {
    /// Keeps points of vectors, of which some lanes are points.
    ///
    /// # Safety
    /// The machine has the instructions of `L`, and the lists have a vector from each start on.
    #[inline(always)]
    unsafe fn keep<L: Lanes>(&mut self, part: Range<usize>, lanes: u32) {
        // Copies stay in registers.
        let (ends, mut kept) = (self.ends.clone(), self.kept);
        let lists = self.lists.each_mut().map(|list| list.as_mut_ptr());
        for start in part.step_by(L::WIDTH) {
            // SAFETY: as the caller ensures; points are kept no later than where they are.
            unsafe {
                let places = lists.map(|list| L::load_ints(list.add(start)));
                let mut mask = lanes;
                for (&v, ends) in places.iter().zip(&ends) {
                    mask &= L::between(v, ends.start, ends.end);
                }
                for (list, v) in lists.into_iter().zip(places) {
                    let v = if N == 0 { v } else { L::compress(v, mask) };
                    L::store_ints(list.add(kept), v);
                }
                kept += mask.count_ones() as usize;
            }
        }
        self.kept = kept;
    }
}

#[cfg(test)]
mod tests {
    use alloc::{vec, vec::Vec};

    use super::*;

    #[test]
    fn points_of_parts_are_kept_by_all_backends() {
        let number = |i: usize| (i * i * 7919 % 211) as i32 - 100;
        let ends = [-90..70, i32::MIN..80, -50..i32::MAX];
        for backend in Backend::available() {
            for parts in [
                vec![0..160, 160..160],
                vec![0..3, 16..33, 48..48, 64..159],
                vec![32..39, 48..48],
            ] {
                let lists = [3, 5, 11].map(|k| (0..160).map(|i| number(k * i)).collect::<Vec<_>>());
                let is_inside = |i: &usize| (0..3).all(|k| ends[k].contains(&lists[k][*i]));
                let expected: Vec<usize> =
                    parts.iter().cloned().flatten().filter(is_inside).collect();
                let mut found = lists.clone();
                let all = found.each_mut().map(Vec::as_mut_slice);
                let kept = retain_parts(backend, all, parts.iter().cloned(), &ends);
                match kept {
                    None => assert_eq!(found, lists),
                    Some(kept) => {
                        for (found, list) in found.iter().zip(&lists) {
                            let expected: Vec<i32> = expected.iter().map(|&i| list[i]).collect();
                            assert_eq!(found[..kept], expected, "{backend:?}");
                        }
                    }
                }
            }
        }
    }
}
