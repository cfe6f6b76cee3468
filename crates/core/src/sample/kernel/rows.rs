//! Rows, plain and warped.

use alloc::vec::Vec;

use super::{
    Backend,
    dispatch::run_vectors,
    format::{Emit, Row},
    lanes::{Lanes, VectorLoop},
};
use crate::sample::warp::PatchShears;

/// The starts of vectors that cover `length` items, or none if there are fewer than fill a vector. The
/// last vector goes back over items that are already written.
#[inline(always)]
pub(super) fn vector_starts<L: Lanes>(length: usize) -> impl Iterator<Item = usize> {
    let last = length.checked_sub(L::WIDTH);
    let ends = last.map_or(0, |_| length);
    (0..ends)
        .step_by(L::WIDTH)
        .map(move |i| i.min(last.unwrap_or(0)))
}

/// Writes one item per column by plain code: the definition.
#[inline(always)]
pub(super) fn emit<F: Emit>(
    format: &F,
    row: Row,
    columns: &[F::Column],
    displacements: &[i32],
    out: &mut [F::Item],
) {
    for ((item, &column), &displacement) in out.iter_mut().zip(columns).zip(displacements) {
        *item = format.item(row.base, column, row.y + displacement, row.lattice);
    }
}

/// Writes one item per column of a row, up to the end of the shortest slice.
#[inline]
pub(crate) fn fill_row<F: Emit>(
    format: &F,
    backend: Backend,
    row: Row,
    columns: &[F::Column],
    displacements: &[i32],
    out: &mut [F::Item],
) {
    let mut plain = PlainRow {
        format,
        row,
        columns,
        displacements,
        out,
    };
    if run_vectors(backend, &mut plain) == 0 {
        emit(format, row, columns, displacements, plain.out);
    }
}

struct PlainRow<'a, F: Emit> {
    format: &'a F,
    row: Row,
    columns: &'a [F::Column],
    displacements: &'a [i32],
    out: &'a mut [F::Item],
}

impl<F: Emit> VectorLoop for PlainRow<'_, F> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let (columns, displacements) = (self.columns, self.displacements);
        // SAFETY: as the caller ensures.
        unsafe {
            self.format
                .vector_row::<L>(self.row, columns, displacements, self.out)
        }
    }
}

/// The columns of a warped row, in which each point moves by itself. All three slices have the same
/// length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WarpedColumns<'a> {
    /// Their displaced x, relative to the patch's origin.
    pub(crate) displaced: &'a [i32],
    /// Their vertical displacements.
    pub(crate) displacements: &'a [i32],
    /// Their lattice coordinates.
    pub(crate) lattice: &'a [i64],
}

impl WarpedColumns<'_> {
    /// The length of the shortest slice, at most `most`.
    fn length(&self, most: usize) -> usize {
        let all = self.displaced.len().min(self.displacements.len());
        all.min(self.lattice.len()).min(most)
    }
}

/// Writes one item per column of a warped row, as many as `out` has room for.
pub(crate) fn fill_warped_row<F: Emit>(
    format: &F,
    backend: Backend,
    shears: &PatchShears,
    row: Row,
    columns: WarpedColumns<'_>,
    out: &mut [F::Item],
) {
    let mut warped = WarpedRow {
        format,
        shears,
        row,
        columns,
        out,
    };
    if run_vectors(backend, &mut warped) == 0 {
        for (i, out) in warped.out.iter_mut().enumerate() {
            let y = row.y + columns.displacements[i];
            let [x, y] = shears.apply(columns.displaced[i], y);
            let column = format.column(row.base, x, columns.lattice[i]);
            *out = format.item(row.base, column, y, row.lattice);
        }
    }
}

struct WarpedRow<'a, F: Emit> {
    format: &'a F,
    shears: &'a PatchShears,
    row: Row,
    columns: WarpedColumns<'a>,
    out: &'a mut [F::Item],
}

impl<F: Emit> VectorLoop for WarpedRow<'_, F> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        // SAFETY: as the caller ensures.
        unsafe {
            if L::IS_PAIRED {
                self.run_side_by_side::<L, 2>()
            } else {
                self.run_side_by_side::<L, 1>()
            }
        }
    }
}

impl<F: Emit> WarpedRow<'_, F> {
    /// Writes `K` vectors at a time.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn run_side_by_side<L: Lanes, const K: usize>(&mut self) -> usize {
        let (columns, row) = (self.columns, self.row);
        let length = columns.length(self.out.len());
        let together = K * L::WIDTH;
        if length < together {
            return 0;
        }
        let mut next = 0;
        while next < length {
            // The last vectors go back over items that are already written.
            let start = next.min(length - together);
            next += together;
            // SAFETY: the machine has the instructions, and all slices have `together` values from
            // `start` on.
            unsafe {
                let y = L::splat_int(row.y);
                let at =
                    |from: &[i32], k: usize| L::load_ints(from.as_ptr().add(start + k * L::WIDTH));
                let xs = core::array::from_fn(|k| at(columns.displaced, k));
                let ys = core::array::from_fn(|k| L::add_ints(at(columns.displacements, k), y));
                let (xs, ys) = warp::<L, K>(self.shears, xs, ys);
                for k in 0..K {
                    let part = start + k * L::WIDTH..start + (k + 1) * L::WIDTH;
                    let (lattice, out) = (&columns.lattice[part.clone()], &mut self.out[part]);
                    self.format
                        .vector_items::<L>(row, [xs[k], ys[k]], lattice, out);
                }
            }
        }
        length
    }
}

/// Warps positions: the x and y of all, whose number is a multiple of 32, into as many places.
pub(crate) fn warp_all(
    backend: Backend,
    shears: &PatchShears,
    displaced: [&[i32]; 2],
    places: &mut [Vec<i32>; 2],
) {
    let [x_places, y_places] = places;
    let length = displaced[0].len();
    let mut all = WarpAll {
        shears,
        displaced: displaced.map(|list| &list[..length]),
        places: [&mut x_places[..length], &mut y_places[..length]],
    };
    if run_vectors(backend, &mut all) < length {
        let [xs, ys] = displaced;
        let [x_places, y_places] = all.places;
        let places = x_places.iter_mut().zip(y_places);
        for ((x_place, y_place), (&x, &y)) in places.zip(xs.iter().zip(ys)) {
            [*x_place, *y_place] = shears.apply(x, y);
        }
    }
}

/// All four slices have the same length.
struct WarpAll<'a> {
    shears: &'a PatchShears,
    displaced: [&'a [i32]; 2],
    places: [&'a mut [i32]; 2],
}

impl VectorLoop for WarpAll<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let length = self.displaced[0].len();
        if !length.is_multiple_of(2 * L::WIDTH) {
            return 0;
        }
        for start in (0..length).step_by(2 * L::WIDTH) {
            // SAFETY: the machine has the instructions, and all slices have two vectors from `start` on.
            unsafe {
                let [xs, ys] = self.displaced.map(|list| {
                    core::array::from_fn(|k| L::load_ints(list.as_ptr().add(start + k * L::WIDTH)))
                });
                let (xs, ys) = warp::<L, 2>(self.shears, xs, ys);
                for k in 0..2 {
                    let [to_x, to_y] = &mut self.places;
                    L::store_ints(to_x.as_mut_ptr().add(start + k * L::WIDTH), xs[k]);
                    L::store_ints(to_y.as_mut_ptr().add(start + k * L::WIDTH), ys[k]);
                }
            }
        }
        length
    }
}

/// Warped positions; see [`PatchShears::apply`].
///
/// # Safety
/// The machine has the instructions of `L`.
#[inline(always)]
unsafe fn warp<L: Lanes, const K: usize>(
    shears: &PatchShears,
    x: [L::Ints; K],
    y: [L::Ints; K],
) -> ([L::Ints; K], [L::Ints; K]) {
    // SAFETY: as the caller ensures.
    unsafe {
        let add = |a: [L::Ints; K], b: [L::Ints; K]| -> [L::Ints; K] {
            core::array::from_fn(|k| L::add_ints(a[k], b[k]))
        };
        let sub = |a: [L::Ints; K], b: [L::Ints; K]| -> [L::Ints; K] {
            core::array::from_fn(|k| L::sub_ints(a[k], b[k]))
        };
        let y = add(y, noise::<L, K>(shears, 0, x));
        let x = add(x, noise::<L, K>(shears, 1, y));
        let rising = noise::<L, K>(shears, 2, sub(x, y));
        let (x, y) = (add(x, rising), add(y, rising));
        let falling = noise::<L, K>(shears, 3, add(x, y));
        (add(x, falling), sub(y, falling))
    }
}

/// g of coordinates across a direction; see [`PatchShears`].
///
/// # Safety
/// The machine has the instructions of `L`.
#[inline(always)]
unsafe fn noise<L: Lanes, const K: usize>(
    shears: &PatchShears,
    direction: usize,
    s: [L::Ints; K],
) -> [L::Ints; K] {
    let table = &shears.quadratics[direction];
    // SAFETY: as the caller ensures.
    unsafe {
        let cells: [L::Ints; K] = core::array::from_fn(|k| L::cells(s[k]));
        let at: [L::Singles; K] = core::array::from_fn(|k| L::singles_of(L::places(s[k])));
        let mut value: [L::Singles; K] = core::array::from_fn(|k| L::pick(&table[2], cells[k]));
        for power in [1, 0] {
            for k in 0..K {
                let term = L::mul_singles(value[k], at[k]);
                value[k] = L::add_singles(term, L::pick(&table[power], cells[k]));
            }
        }
        core::array::from_fn(|k| L::truncate(value[k]))
    }
}
