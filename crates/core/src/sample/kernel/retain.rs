//! Points between bounds, picked out of lists.

use core::ops::Range;

use super::{
    Backend,
    backend::run_vectors,
    lanes::{Lanes, VectorLoop},
};

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
