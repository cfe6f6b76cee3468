//! Rows, plain and warped.

use alloc::vec::Vec;

use super::{
    Backend,
    dispatch::run_vectors,
    format::{Emit, Row},
    lanes::{Lanes, VectorLoop},
};
use crate::sample::warp::{CELL_BITS, PatchShears};

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
    /// Their vertical displacements, with the first shear of the warp, which is the same in all rows.
    pub(crate) displacements: &'a [i32],
    /// Bounds of these.
    pub(crate) range: [i32; 2],
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
            let [x, y] = shears.apply_others(columns.displaced[i], y);
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
        // In most rows the second shear has one cell for all points.
        let [least, most] = self.columns.range.map(|dy| (self.row.y + dy) >> CELL_BITS);
        // SAFETY: as the caller ensures.
        unsafe {
            match (L::IS_PAIRED, least == most) {
                (true, true) => self.run_side_by_side::<L, 2, true>(),
                (true, false) => self.run_side_by_side::<L, 2, false>(),
                (false, true) => self.run_side_by_side::<L, 1, true>(),
                (false, false) => self.run_side_by_side::<L, 1, false>(),
            }
        }
    }
}

impl<F: Emit> WarpedRow<'_, F> {
    /// Writes `K` vectors at a time. With `ONE_CELL`, all y of the row lie in one cell of the second shear.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn run_side_by_side<L: Lanes, const K: usize, const ONE_CELL: bool>(&mut self) -> usize {
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
                let xs = loaded::<L, K>(columns.displaced.as_ptr().add(start));
                let dys = loaded::<L, K>(columns.displacements.as_ptr().add(start));
                let ys = added::<L, K>(dys, [y; K]);
                let moved = if ONE_CELL {
                    let cell = (row.y + columns.range[0]) >> CELL_BITS;
                    noise_of_cell::<L, K>(self.shears, 1, cell, ys)
                } else {
                    noise::<L, K>(self.shears, 1, ys)
                };
                let (xs, ys) = last_shears::<L, K>(self.shears, added::<L, K>(xs, moved), ys);
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
                let xs = loaded::<L, 2>(self.displaced[0].as_ptr().add(start));
                let ys = loaded::<L, 2>(self.displaced[1].as_ptr().add(start));
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

/// Lane by lane sums. Loops instead of closures, which the compiler does not always inline into code for
/// wider vectors.
///
/// # Safety
/// The machine has the instructions of `L`.
#[inline(always)]
unsafe fn added<L: Lanes, const K: usize>(mut a: [L::Ints; K], b: [L::Ints; K]) -> [L::Ints; K] {
    for k in 0..K {
        // SAFETY: as the caller ensures.
        a[k] = unsafe { L::add_ints(a[k], b[k]) };
    }
    a
}

/// Lane by lane differences.
///
/// # Safety
/// The machine has the instructions of `L`.
#[inline(always)]
unsafe fn less<L: Lanes, const K: usize>(mut a: [L::Ints; K], b: [L::Ints; K]) -> [L::Ints; K] {
    for k in 0..K {
        // SAFETY: as the caller ensures.
        a[k] = unsafe { L::sub_ints(a[k], b[k]) };
    }
    a
}

/// `K` vectors of values.
///
/// # Safety
/// The machine has the instructions of `L`, and `K` vectors begin at `from`.
#[inline(always)]
unsafe fn loaded<L: Lanes, const K: usize>(from: *const i32) -> [L::Ints; K] {
    // SAFETY: as the caller ensures.
    unsafe {
        let mut all = [L::load_ints(from); K];
        for (k, vector) in all.iter_mut().enumerate().skip(1) {
            *vector = L::load_ints(from.add(k * L::WIDTH));
        }
        all
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
        let y = added::<L, K>(y, noise::<L, K>(shears, 0, x));
        let x = added::<L, K>(x, noise::<L, K>(shears, 1, y));
        last_shears::<L, K>(shears, x, y)
    }
}

/// Positions after the two shears along the diagonals.
///
/// # Safety
/// The machine has the instructions of `L`.
#[inline(always)]
unsafe fn last_shears<L: Lanes, const K: usize>(
    shears: &PatchShears,
    x: [L::Ints; K],
    y: [L::Ints; K],
) -> ([L::Ints; K], [L::Ints; K]) {
    // SAFETY: as the caller ensures.
    unsafe {
        let rising = noise::<L, K>(shears, 2, less::<L, K>(x, y));
        let (x, y) = (added::<L, K>(x, rising), added::<L, K>(y, rising));
        let falling = noise::<L, K>(shears, 3, added::<L, K>(x, y));
        (added::<L, K>(x, falling), less::<L, K>(y, falling))
    }
}

/// g of coordinates that all lie in one cell; see [`noise`].
///
/// # Safety
/// The machine has the instructions of `L`.
#[inline(always)]
unsafe fn noise_of_cell<L: Lanes, const K: usize>(
    shears: &PatchShears,
    direction: usize,
    cell: i32,
    s: [L::Ints; K],
) -> [L::Ints; K] {
    let cell = cell as usize % PatchShears::CELLS;
    let [constant, linear, square] = &shears.quadratics[direction];
    let mut all = s;
    // SAFETY: as the caller ensures.
    unsafe {
        let constant = L::splat_single(constant[cell]);
        let linear = L::splat_single(linear[cell]);
        let square = L::splat_single(square[cell]);
        for k in 0..K {
            let at = L::singles_of(L::places(s[k]));
            let value = L::add_singles(L::mul_singles(square, at), linear);
            all[k] = L::truncate(L::add_singles(L::mul_singles(value, at), constant));
        }
    }
    all
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
    let [constant, linear, square] = &shears.quadratics[direction];
    let mut all = s;
    // SAFETY: as the caller ensures.
    unsafe {
        for k in 0..K {
            let cells = L::cells(s[k]);
            let at = L::singles_of(L::places(s[k]));
            let value = L::mul_singles(L::pick(square, cells), at);
            let value = L::mul_singles(L::add_singles(value, L::pick(linear, cells)), at);
            all[k] = L::truncate(L::add_singles(value, L::pick(constant, cells)));
        }
    }
    all
}
