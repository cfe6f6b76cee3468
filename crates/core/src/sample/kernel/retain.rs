//! Points between bounds, picked out of lists.

use core::ops::Range;

use super::{
    Backend,
    backend::run_vectors,
    lanes::{Lanes, VectorLoop},
};

/// Keeps the points of some parts of three lists that lie between bounds: moves them to the front. Parts ascend and begin
/// at multiples of 16, of which the length of the lists is one, too. Returns the number of points kept, or `None`, and
/// leaves the lists, unless vectors can do it.
pub(crate) fn retain_parts(
    backend: Backend,
    lists: [&mut [i32]; 3],
    parts: impl Iterator<Item = Range<usize>> + Clone,
    ends: &[Range<i32>; 3],
) -> Option<usize> {
    let mut retain = Retain {
        lists,
        parts,
        ends,
        kept: 0,
    };
    (run_vectors(backend, &mut retain) > 0).then_some(retain.kept)
}

struct Retain<'a, P> {
    lists: [&'a mut [i32]; 3],
    parts: P,
    ends: &'a [Range<i32>; 3],
    kept: usize,
}

impl<P: Iterator<Item = Range<usize>> + Clone> VectorLoop for Retain<'_, P> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let length = self.lists[0].len();
        let is_whole = |list: &&mut [i32]| list.len() == length;
        if !L::HAS_TRIPLES || !length.is_multiple_of(L::WIDTH) || !self.lists.iter().all(is_whole) {
            return 0;
        }
        let keeps_all = self.ends.iter().all(|ends| *ends == (i32::MIN..i32::MAX));
        let mut kept = 0;
        for part in self.parts.clone() {
            assert!(
                part.start.is_multiple_of(L::WIDTH) && part.end <= length && kept <= part.start
            );
            for start in part.clone().step_by(L::WIDTH) {
                let number = (part.end - start).min(L::WIDTH);
                let mut mask = u32::MAX >> (32 - number);
                // SAFETY: the machine has the instructions, the lists have a vector from `start` on, and so from where
                // points are kept, which is not behind it.
                unsafe {
                    let places =
                        [0, 1, 2].map(|axis| L::load_ints(self.lists[axis].as_ptr().add(start)));
                    if keeps_all {
                        for (list, v) in self.lists.iter_mut().zip(places) {
                            L::store_ints(list.as_mut_ptr().add(kept), v);
                        }
                        kept += number;
                        continue;
                    }
                    for (v, ends) in places.iter().zip(self.ends) {
                        mask &= L::between(*v, ends.start, ends.end);
                    }
                    for (list, v) in self.lists.iter_mut().zip(places) {
                        L::store_ints(list.as_mut_ptr().add(kept), L::compress(v, mask));
                    }
                }
                kept += mask.count_ones() as usize;
            }
        }
        self.kept = kept;
        length
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
