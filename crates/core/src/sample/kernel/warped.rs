//! Warped rows and lists: every point moves by itself.
//!
//! A point takes a chain of some sixty operations that wait for each other, longer than processors look ahead. So
//! a row is warped in two passes: the first writes the places after the shear along x and the first diagonal
//! one, some vectors at a time, and the second, which finds them in the cache, does the rest.

use alloc::vec::Vec;
use core::{mem::MaybeUninit, ops::Range};

use super::{
    Backend,
    backend::run_vectors,
    format::{Emit, Row},
    lanes::{Lanes, VectorLoop},
};
use crate::sample::warp::{CELL_BITS, PatchShears};

/// The number of vectors of a pass.
const PASS: usize = 16;

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
    /// The first column of the right half.
    pub(crate) middle: usize,
    /// Bounds of the displaced x of both halves.
    pub(crate) extents: [[i32; 2]; 2],
}

impl WarpedColumns<'_> {
    /// The length of the shortest slice, at most `most`.
    fn length(&self, most: usize) -> usize {
        let all = self.displaced.len().min(self.displacements.len());
        all.min(self.lattice.len()).min(most)
    }
}

/// Writes one item for each column of a warped row until `out` is full.
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
        let WarpedColumns {
            middle, extents, ..
        } = self.columns;
        let length = self.columns.length(self.out.len());
        if length < L::WIDTH {
            return 0;
        }
        // SAFETY: as the caller ensures; parts have at least a vector.
        unsafe {
            if L::WINDOW < PatchShears::CELLS && (L::WIDTH..=length - L::WIDTH).contains(&middle) {
                self.run_part::<L>(0..middle, extents[0]);
                self.run_part::<L>(middle..length, extents[1]);
            } else {
                let [left, right] = extents;
                let all = [left[0].min(right[0]), left[1].max(right[1])];
                self.run_part::<L>(0..length, all);
            }
        }
        length
    }
}

impl<F: Emit> WarpedRow<'_, F> {
    /// Writes the items of some columns, at least a vector of them, whose displaced x have some bounds.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn run_part<L: Lanes>(&mut self, part: Range<usize>, x: [i32; 2]) {
        let (shears, y) = (self.shears, self.columns.range.map(|dy| self.row.y + dy));
        let [along_x, rising] = [1, 2].map(|direction| shears.bounds[direction]);
        // Where the diagonal shears are looked up.
        let x = [x[0] + along_x[0], x[1] + along_x[1]];
        let third = [x[0] - y[1], x[1] - y[0]];
        let fourth = [x[0] + y[0] + 2 * rising[0], x[1] + y[1] + 2 * rising[1]];
        let [second, third, fourth] = [y, third, fourth].map(|s| s.map(|s| s >> CELL_BITS));
        let [second_all, third_all, fourth_all] = [1, 2, 3].map(|i| &shears.quadratics[i]);
        let is_near = [third, fourth]
            .iter()
            .all(|[first, last]| last - first < L::WINDOW as i32);
        // SAFETY: as the caller ensures.
        unsafe {
            if is_near && second[0] == second[1] {
                // In most rows the second shear has one cell for all points.
                let second = OneCell::<L>::new(second_all, second[0]);
                let third = Near::<L>::new(third_all, third[0]);
                self.run_by::<L>(part, second, third, Near::<L>::new(fourth_all, fourth[0]));
            } else if is_near {
                let third = Near::<L>::new(third_all, third[0]);
                let fourth = Near::<L>::new(fourth_all, fourth[0]);
                self.run_by::<L>(part, Any(second_all), third, fourth);
            } else {
                self.run_by::<L>(part, Any(second_all), Any(third_all), Any(fourth_all));
            }
        }
    }

    /// Writes the items of some columns, at least a vector of them, by the last three shears.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn run_by<L: Lanes>(
        &mut self,
        part: Range<usize>,
        second: impl Quadratics<L>,
        third: impl Quadratics<L>,
        fourth: impl Quadratics<L>,
    ) {
        let (columns, row, format) = (self.columns, self.row, *self.format);
        let last = part.end - L::WIDTH;
        let mut places = [const { MaybeUninit::<[L::Ints; 2]>::uninit() }; PASS];
        let mut next = part.start;
        while next < part.end {
            let pass = (part.end - next).div_ceil(L::WIDTH).min(PASS);
            // SAFETY: the machine has the instructions, and all slices have WIDTH values from each start on. The
            // last vector goes back over items that are already written.
            unsafe {
                let y = L::splat_int(row.y);
                for (k, place) in places[..pass].iter_mut().enumerate() {
                    let start = (next + k * L::WIDTH).min(last);
                    let x = L::load_ints(columns.displaced.as_ptr().add(start));
                    let y = L::add_ints(L::load_ints(columns.displacements.as_ptr().add(start)), y);
                    let x = L::add_ints(x, noise(second, y));
                    let rising = noise(third, L::sub_ints(x, y));
                    place.write([L::add_ints(x, rising), L::add_ints(y, rising)]);
                }
                for (k, place) in places[..pass].iter().enumerate() {
                    let start = (next + k * L::WIDTH).min(last);
                    // Written above.
                    let [x, y] = place.assume_init();
                    let falling = noise(fourth, L::add_ints(x, y));
                    let position = [L::add_ints(x, falling), L::sub_ints(y, falling)];
                    let lattice = &columns.lattice[start..start + L::WIDTH];
                    let out = &mut self.out[start..start + L::WIDTH];
                    format.vector_items::<L>(row, position, lattice, out);
                }
            }
            next += pass * L::WIDTH;
        }
    }
}

/// Adds the movement of the first shear, which depends on x alone, to the displacements of columns.
pub(crate) fn add_first_shear(
    backend: Backend,
    shears: &PatchShears,
    displaced: &[i32],
    displacements: &mut [i32],
) {
    let mut columns = FirstShear {
        shears,
        displaced,
        displacements,
    };
    let done = run_vectors(backend, &mut columns);
    let rest = columns.displacements.iter_mut().zip(displaced);
    for (dy, &x) in rest.skip(done) {
        *dy += shears.first(x);
    }
}

struct FirstShear<'a> {
    shears: &'a PatchShears,
    displaced: &'a [i32],
    displacements: &'a mut [i32],
}

impl VectorLoop for FirstShear<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let length = self.displaced.len().min(self.displacements.len());
        let quadratics = Any(&self.shears.quadratics[0]);
        let starts = (0..length - length % L::WIDTH).step_by(L::WIDTH);
        for start in starts {
            // SAFETY: the machine has the instructions, and both slices have a vector from `start` on.
            unsafe {
                let to = self.displacements.as_mut_ptr().add(start);
                let moved =
                    noise::<L>(quadratics, L::load_ints(self.displaced.as_ptr().add(start)));
                L::store_ints(to, L::add_ints(L::load_ints(to), moved));
            }
        }
        length - length % L::WIDTH
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
        if !length.is_multiple_of(L::WIDTH) {
            return 0;
        }
        let (all, cells) = (&self.shears.quadratics, self.shears.cells);
        let is_near = cells
            .iter()
            .all(|[first, last]| last - first < L::WINDOW as i32);
        // SAFETY: as the caller ensures.
        unsafe {
            if is_near {
                self.run_by::<L, _>([
                    Near::<L>::new(&all[0], cells[0][0]),
                    Near::<L>::new(&all[1], cells[1][0]),
                    Near::<L>::new(&all[2], cells[2][0]),
                    Near::<L>::new(&all[3], cells[3][0]),
                ]);
            } else {
                self.run_by::<L, _>([Any(&all[0]), Any(&all[1]), Any(&all[2]), Any(&all[3])]);
            }
        }
        length
    }
}

impl WarpAll<'_> {
    /// # Safety
    /// The machine has the instructions of `L`, and the length is a multiple of their width.
    #[inline(always)]
    unsafe fn run_by<L: Lanes, Q: Quadratics<L>>(&mut self, shears: [Q; 4]) {
        let length = self.displaced[0].len();
        let [to_x, to_y] = &mut self.places;
        let mut next = 0;
        while next < length {
            let end = length.min(next + PASS * L::WIDTH);
            // SAFETY: the machine has the instructions, and all slices have a vector from each start on.
            unsafe {
                for start in (next..end).step_by(L::WIDTH) {
                    let x = L::load_ints(self.displaced[0].as_ptr().add(start));
                    let y = L::load_ints(self.displaced[1].as_ptr().add(start));
                    let y = L::add_ints(y, noise(shears[0], x));
                    let x = L::add_ints(x, noise(shears[1], y));
                    L::store_ints(to_x.as_mut_ptr().add(start), x);
                    L::store_ints(to_y.as_mut_ptr().add(start), y);
                }
                for start in (next..end).step_by(L::WIDTH) {
                    let x = L::load_ints(to_x.as_ptr().add(start));
                    let y = L::load_ints(to_y.as_ptr().add(start));
                    let rising = noise(shears[2], L::sub_ints(x, y));
                    let (x, y) = (L::add_ints(x, rising), L::add_ints(y, rising));
                    let falling = noise(shears[3], L::add_ints(x, y));
                    L::store_ints(to_x.as_mut_ptr().add(start), L::add_ints(x, falling));
                    L::store_ints(to_y.as_mut_ptr().add(start), L::sub_ints(y, falling));
                }
            }
            next = end;
        }
    }
}

/// The quadratics of a direction, in the form in which coordinates of some cells find theirs.
trait Quadratics<L: Lanes>: Copy {
    /// The coefficients of the cells of coordinates: constant, linear, square.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    unsafe fn of(self, s: L::Ints) -> [L::Singles; 3];
}

/// g of coordinates across a direction; see [`PatchShears`].
///
/// # Safety
/// The machine has the instructions of `L`.
#[inline(always)]
unsafe fn noise<L: Lanes>(quadratics: impl Quadratics<L>, s: L::Ints) -> L::Ints {
    // SAFETY: as the caller ensures.
    unsafe {
        let [constant, linear, square] = quadratics.of(s);
        let at = L::singles_of(L::places(s));
        let value = L::add_singles(L::mul_singles(square, at), linear);
        L::truncate(L::add_singles(L::mul_singles(value, at), constant))
    }
}

/// The coefficients of the one cell in which all coordinates lie.
struct OneCell<L: Lanes>([L::Singles; 3]);

/// The coefficients of as many cells as a table has.
struct Near<L: Lanes>([L::Table; 3]);

/// The coefficients of all cells.
#[derive(Clone, Copy)]
struct Any<'a>(&'a [[f32; PatchShears::CELLS]; 3]);

impl<L: Lanes> Clone for OneCell<L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lanes> Copy for OneCell<L> {}

impl<L: Lanes> Clone for Near<L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lanes> Copy for Near<L> {}

impl<L: Lanes> OneCell<L> {
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn new([constant, linear, square]: &[[f32; PatchShears::CELLS]; 3], cell: i32) -> Self {
        let cell = cell as usize % PatchShears::CELLS;
        // SAFETY: as the caller ensures.
        unsafe {
            Self([
                L::splat_single(constant[cell]),
                L::splat_single(linear[cell]),
                L::splat_single(square[cell]),
            ])
        }
    }
}

impl<L: Lanes> Near<L> {
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn new([constant, linear, square]: &[[f32; PatchShears::CELLS]; 3], first: i32) -> Self {
        // SAFETY: as the caller ensures.
        unsafe {
            Self([
                L::table(constant, first),
                L::table(linear, first),
                L::table(square, first),
            ])
        }
    }
}

impl<L: Lanes> Quadratics<L> for OneCell<L> {
    #[inline(always)]
    unsafe fn of(self, _: L::Ints) -> [L::Singles; 3] {
        self.0
    }
}

impl<L: Lanes> Quadratics<L> for Near<L> {
    #[inline(always)]
    unsafe fn of(self, s: L::Ints) -> [L::Singles; 3] {
        let [constant, linear, square] = self.0;
        // SAFETY: as the caller ensures.
        unsafe {
            let cells = L::cells(s);
            [
                L::pick(constant, cells),
                L::pick(linear, cells),
                L::pick(square, cells),
            ]
        }
    }
}

impl<L: Lanes> Quadratics<L> for Any<'_> {
    #[inline(always)]
    unsafe fn of(self, s: L::Ints) -> [L::Singles; 3] {
        let [constant, linear, square] = self.0;
        // SAFETY: as the caller ensures.
        unsafe {
            let cells = L::cells(s);
            [
                L::pick_any(constant, cells),
                L::pick_any(linear, cells),
                L::pick_any(square, cells),
            ]
        }
    }
}
