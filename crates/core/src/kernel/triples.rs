//! Points in space as triples of `f32`, from numbers that are ready.

use super::{
    Backend,
    backend::{compiled_loop, run_vectors},
    lanes::{Lanes, PlainLoop, VectorLoop},
    listing::vector_starts,
};

/// Writes a triple for each of some points, as many as `out` has: its number along x, and those that its place in two
/// lists picks along y and z. Where there are 32 numbers to pick from, or a multiple, vectors do it.
pub(crate) fn pick_triples(
    backend: Backend,
    xs: &[f32],
    places: &[u16],
    across: [&[f32]; 2],
    out: &mut [[f32; 3]],
) {
    let mut picked = Picked {
        xs,
        places,
        across,
        out,
    };
    if run_vectors(backend, &mut picked) == 0 {
        pick_pairs(backend, xs, places, across, picked.out);
    }
}

/// [`pick_triples`] of any numbers, by plain code. The numbers along y and z that a place picks are copied together.
pub(crate) fn pick_pairs<T: Copy + Default>(
    backend: Backend,
    xs: &[T],
    places: &[u16],
    across: [&[T]; 2],
    out: &mut [[T; 3]],
) {
    /// From this number of points on, pairs are worth their table.
    const MANY: usize = 24;
    let [ys, zs] = across;
    if out.len() < MANY || ys.len().max(zs.len()) > PICKS {
        for ((out, &x), &place) in out.iter_mut().zip(xs).zip(places) {
            let place = usize::from(place);
            *out = [x, ys[place], zs[place]];
        }
        return;
    }
    let mut pairs = Pairs {
        xs,
        places,
        across,
        out,
    };
    compiled_loop(backend, &mut pairs);
}

struct Pairs<'a, T> {
    xs: &'a [T],
    places: &'a [u16],
    across: [&'a [T]; 2],
    out: &'a mut [[T; 3]],
}

impl<T: Copy + Default> PlainLoop for Pairs<'_, T> {
    #[inline(always)]
    fn run(&mut self) {
        let mut pairs = [[T::default(); 2]; PICKS];
        let [ys, zs] = self.across;
        for ((pair, &y), &z) in pairs.iter_mut().zip(ys).zip(zs) {
            *pair = [y, z];
        }
        for ((out, &x), &place) in self.out.iter_mut().zip(self.xs).zip(self.places) {
            let [y, z] = pairs[usize::from(place) % PICKS];
            *out = [x, y, z];
        }
    }
}

/// Writes numbers side by side, up to the end of the shortest list.
pub(crate) fn write_triples(backend: Backend, parts: [&[f32]; 3], out: &mut [[f32; 3]]) {
    let mut joined = Joined { parts, out };
    if run_vectors(backend, &mut joined) == 0 {
        let [xs, ys, zs] = parts;
        for (((out, &x), &y), &z) in joined.out.iter_mut().zip(xs).zip(ys).zip(zs) {
            *out = [x, y, z];
        }
    }
}

/// Adds to each of some numbers the one that its place in a list picks, up to the end of the shortest list.
pub(crate) fn add_picked(
    backend: Backend,
    numbers: &[i32],
    places: &[u16],
    picks: &[i32],
    out: &mut [i32],
) {
    let mut sums = Sums {
        numbers,
        places,
        picks,
        out,
    };
    if run_vectors(backend, &mut sums) == 0 {
        for ((out, &number), &place) in sums.out.iter_mut().zip(numbers).zip(places) {
            *out = number + picks[usize::from(place)];
        }
    }
}

struct Sums<'a> {
    numbers: &'a [i32],
    places: &'a [u16],
    picks: &'a [i32],
    out: &'a mut [i32],
}

impl VectorLoop for Sums<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let length = self.out.len().min(self.numbers.len());
        let length = length.min(self.places.len());
        if !L::HAS_TRIPLES || self.picks.len() != PICKS || length < L::WIDTH {
            return 0;
        }
        // SAFETY: the machine has the instructions, WIDTH values from `i` on lie within all slices, and there are as
        // many numbers as vectors pick from, whatever the places are.
        unsafe {
            let tables = L::two_tables(self.picks.as_ptr().cast());
            for i in vector_starts::<L>(length) {
                let places = L::load_places(self.places.as_ptr().add(i));
                let picked = L::bits_of(L::pick_of_two(tables, places));
                let number = L::load_ints(self.numbers.as_ptr().add(i));
                L::store_ints(self.out.as_mut_ptr().add(i), L::add_ints(number, picked));
            }
        }
        length
    }
}

/// Adds a number to those that some places pick from a list, up to the end of the shorter of `places` and `out`.
pub(crate) fn lift_picked(
    backend: Backend,
    lift: i32,
    places: &[u16],
    picks: &[i32],
    out: &mut [i32],
) {
    let mut lifted = Lifted {
        lift,
        places,
        picks,
        out,
    };
    if run_vectors(backend, &mut lifted) == 0 {
        for (out, &place) in lifted.out.iter_mut().zip(places) {
            *out = lift + picks[usize::from(place)];
        }
    }
}

struct Lifted<'a> {
    lift: i32,
    places: &'a [u16],
    picks: &'a [i32],
    out: &'a mut [i32],
}

impl VectorLoop for Lifted<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let length = self.out.len().min(self.places.len());
        if !L::HAS_TRIPLES || self.picks.len() != PICKS || length < L::WIDTH {
            return 0;
        }
        // SAFETY: as for sums.
        unsafe {
            let tables = L::two_tables(self.picks.as_ptr().cast());
            let lift = L::splat_int(self.lift);
            for i in vector_starts::<L>(length) {
                let places = L::load_places(self.places.as_ptr().add(i));
                let picked = L::bits_of(L::pick_of_two(tables, places));
                L::store_ints(self.out.as_mut_ptr().add(i), L::add_ints(picked, lift));
            }
        }
        length
    }
}

struct Picked<'a> {
    xs: &'a [f32],
    places: &'a [u16],
    across: [&'a [f32]; 2],
    out: &'a mut [[f32; 3]],
}

/// The numbers that vectors pick from.
pub(crate) const PICKS: usize = 32;

impl VectorLoop for Picked<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let [ys, zs] = self.across;
        let length = self.out.len().min(self.xs.len()).min(self.places.len());
        let fits = [ys, zs].iter().all(|list| list.len() == PICKS);
        if !L::HAS_TRIPLES || !fits || length < L::WIDTH {
            return 0;
        }
        // SAFETY: the machine has the instructions, WIDTH values from `i` on lie within all slices, and the lists have
        // as many numbers as vectors pick from, whatever the places are.
        unsafe {
            let tables = [ys, zs].map(|list| L::two_tables(list.as_ptr()));
            for i in vector_starts::<L>(length) {
                let x = L::load_singles(self.xs.as_ptr().add(i));
                let places = L::load_places(self.places.as_ptr().add(i));
                let [y, z] = tables.map(|tables| L::pick_of_two(tables, places));
                L::store_single_triples(self.out.as_mut_ptr().add(i), [x, y, z]);
            }
        }
        length
    }
}

struct Joined<'a> {
    parts: [&'a [f32]; 3],
    out: &'a mut [[f32; 3]],
}

impl VectorLoop for Joined<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let lengths = self.parts.iter().map(|list| list.len());
        let length = lengths.fold(self.out.len(), usize::min);
        if !L::HAS_TRIPLES || length < L::WIDTH {
            return 0;
        }
        // SAFETY: the machine has the instructions, and WIDTH values from `i` on lie within all slices.
        unsafe {
            let [xs, ys, zs] = self.parts.map(<[f32]>::as_ptr);
            for i in vector_starts::<L>(length) {
                let parts = [
                    L::load_singles(xs.add(i)),
                    L::load_singles(ys.add(i)),
                    L::load_singles(zs.add(i)),
                ];
                L::store_single_triples(self.out.as_mut_ptr().add(i), parts);
            }
        }
        length
    }
}

#[cfg(test)]
mod tests {
    use alloc::{vec, vec::Vec};

    use super::*;

    #[test]
    fn triples_have_the_same_bits_by_all_backends() {
        let numbers: Vec<f32> = (0..200).map(|i| (i * i) as f32 * 0.37 - 5.0).collect();
        let places: Vec<u16> = (0..200).map(|i| (i * i + i / 3) % 32).collect();
        for backend in Backend::available() {
            for length in 0..70 {
                for (start, count) in [(0, 32), (3, 32), (1, 33)] {
                    let xs = &numbers[start + 7..][..length];
                    let places = &places[start..][..length];
                    let across = [&numbers[start..][..count], &numbers[start + 50..][..count]];
                    let numbers: Vec<i32> = (0..100).map(|i| i * i * 7919 - 300_000).collect();
                    let mut sums = vec![7; length + 2];
                    let picks = &numbers[start..][..count];
                    add_picked(backend, &numbers[9..], places, picks, &mut sums[1..=length]);
                    for (i, &sum) in sums[1..=length].iter().enumerate() {
                        assert_eq!(sum, numbers[9 + i] + picks[usize::from(places[i])]);
                    }
                    lift_picked(backend, -5, places, picks, &mut sums[1..=length]);
                    for (&place, &sum) in places.iter().zip(&sums[1..]) {
                        assert_eq!(sum, picks[usize::from(place)] - 5);
                    }
                    assert_eq!([sums[0], sums[length + 1]], [7, 7]);
                    let [mut picked, mut joined] = [(); 2].map(|()| vec![[-1.0; 3]; length + 2]);
                    pick_triples(backend, xs, places, across, &mut picked[1..=length]);
                    let made: Vec<[f32; 3]> = (0..length)
                        .map(|i| {
                            let place = usize::from(places[i]);
                            [xs[i], across[0][place], across[1][place]]
                        })
                        .collect();
                    assert_eq!(picked[1..=length], made, "{backend:?} {length}");
                    let [xs, ys, zs] = [xs, across[0], across[1]]
                        .map(|list| list.iter().map(|&v| f64::from(v)).collect::<Vec<f64>>());
                    let mut doubles = vec![[-1.0; 3]; length + 2];
                    pick_pairs(backend, &xs, places, [&ys, &zs], &mut doubles[1..=length]);
                    let wide = made.iter().map(|triple| triple.map(f64::from));
                    assert!(doubles[1..=length].iter().copied().eq(wide));
                    assert_eq!([doubles[0], doubles[length + 1]], [[-1.0; 3]; 2]);
                    let [x, y, z] = [0, 1, 2].map(|axis| {
                        let parts = made.iter().map(|triple| triple[axis]);
                        parts.collect::<Vec<f32>>()
                    });
                    write_triples(backend, [&x, &y, &z], &mut joined[1..=length]);
                    assert_eq!(joined[1..=length], made, "{backend:?} {length}");
                    for list in [picked, joined] {
                        assert_eq!([list[0], list[length + 1]], [[-1.0; 3]; 2]);
                    }
                }
            }
        }
    }
}
