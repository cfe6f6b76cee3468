//! Warped rows and lists: every point moves by itself.
//!
//! A point takes a chain of some sixty operations that wait for each other, longer than processors look ahead. So
//! a row is warped in two passes: the first writes the places after the shear along x and the first diagonal
//! one, some vectors at a time, and the second, which finds them in the cache, does the rest.
//!
//! The coefficients of a shear are looked up by the cell of each lane. A patch has some forty cells in a direction,
//! more than a vector, but neighbors in a row are near each other: successive columns and bounds of everything else
//! leave few cells. So each vector of a row has a table of its own, a load from the first cell that its points can
//! touch, and where even that is known to hold all cells, one permutation finds a coefficient ([`Near`]). Sixteen
//! cells take two on machines of short vectors ([`AtOnce`]), and more are gathered ([`Any`]). Lists jump from row to
//! row; there the cells are those of a pass.

use core::{mem::MaybeUninit, ops::Range};

use super::{
    Backend,
    backend::run_vectors,
    format::{Emit, Row},
    lanes::{Lanes, VectorLoop, stored},
    quadratics::{Any, AtOnce, Near, Quadratics, Tables, noise},
};
use crate::{
    table::FRACTION_BITS,
    warp::{CELL_BITS, KNOT_BITS, PatchShears},
};

/// The number of vectors of a pass.
const PASS: usize = 16;

/// The columns of a warped row, in which each point moves by itself. All three slices have the same
/// length.
#[derive(Clone, Copy, Debug)]
pub struct WarpedColumns<'a> {
    /// Their displaced x, relative to the patch's origin.
    pub(crate) displaced: &'a [i32],
    /// Their vertical displacements, with the first shear of the warp, which is the same in all rows.
    pub(crate) displacements: &'a [i32],
    /// Bounds of these.
    pub(crate) range: [i32; 2],
    /// Their lattice coordinates.
    pub(crate) lattice: &'a [i64],
    /// The place of the displaced columns in the lattice.
    pub(crate) extent: Extent,
}

/// How far columns are displaced, and how far from each other.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Extent {
    /// The lattice column of the patch's origin.
    pub(crate) origin: i64,
    /// Bounds of the horizontal displacements.
    pub(crate) reach: [i32; 2],
    /// The greatest distance from the first to the last of 8 and of 16 successive columns, in the lattice.
    widths: [i32; 2],
}

impl Extent {
    /// The extent of columns of the lattice.
    pub(crate) fn new(origin: i64, reach: [i32; 2], lattice: &[i64]) -> Self {
        let widest = |number: usize| {
            let ends = lattice.iter().zip(lattice.get(number - 1..).unwrap_or(&[]));
            ends.map(|(first, last)| (last - first) as i32)
                .fold(0, i32::max)
        };
        Self {
            origin,
            reach,
            widths: [8, 16].map(widest),
        }
    }

    /// The greatest distance between the displaced columns of a vector.
    fn width<L: Lanes>(&self) -> i64 {
        let columns = self.widths[usize::from(L::WIDTH > 8)];
        let [least, most] = self.reach.map(i64::from);
        (i64::from(columns) << FRACTION_BITS) + most - least
    }

    /// The lead that [`cell`] adds to a lattice column to find the first cell that the values from `least` above it
    /// on touch.
    fn lead(&self, least: i32) -> i64 {
        i64::from(least >> FRACTION_BITS) - self.origin
    }
}

/// The first cell of the values of a column.
#[inline(always)]
const fn cell(column: i64, lead: i64) -> i32 {
    ((column + lead) >> KNOT_BITS) as i32
}

/// Whether values that differ by at most `width` touch at most some number of cells.
const fn fits(width: i64, cells: usize) -> bool {
    width <= (cells as i64 - 1) << CELL_BITS
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
        let length = self.columns.length(self.out.len());
        if length < L::WIDTH {
            return 0;
        }
        let (shears, columns) = (self.shears, self.columns);
        let second = columns.range.map(|dy| self.row.y + dy);
        let widths = self.widths(columns.extent.width::<L>());
        let fit = |cells| widths.iter().all(|&width| fits(width, cells));
        let has_one = fits(i64::from(second[1]) - i64::from(second[0]), L::WINDOW);
        // SAFETY: as the caller ensures; there is at least a vector.
        unsafe {
            let second = Near::<L>::new(Tables::new(shears, 1), second[0] >> CELL_BITS);
            if has_one && fit(L::WINDOW) {
                self.run_by::<L, _, Near<L>>(length, second);
            } else if has_one && fit(PatchShears::AT_ONCE) {
                self.run_by::<L, _, AtOnce<L>>(length, second);
            } else {
                let second = Any::<L>::new(Tables::new(shears, 1), 0);
                self.run_by::<L, _, Any<L>>(length, second);
            }
        }
        length
    }
}

impl<F: Emit> WarpedRow<'_, F> {
    /// The greatest differences of the coordinates across the third and the fourth shear, of points whose displaced x
    /// differ by at most `width`.
    fn widths(&self, width: i64) -> [i64; 2] {
        let [along_x, rising] = [1, 2].map(|direction| self.shears.bounds[direction]);
        let length = |[least, most]: [i32; 2]| i64::from(most) - i64::from(least);
        let third = width + length(along_x) + length(self.columns.range);
        [third, third + 2 * length(rising)]
    }

    /// The leads that [`cell`] adds to columns to find the first cells of the third and of the fourth shear.
    fn leads(&self) -> [i64; 2] {
        let WarpedColumns { range, extent, .. } = self.columns;
        let [along_x, rising] = [1, 2].map(|direction| self.shears.bounds[direction][0]);
        let [low, high] = range.map(|dy| self.row.y + dy);
        let x = extent.reach[0] + along_x;
        [x - high, x + low + 2 * rising].map(|least| extent.lead(least))
    }

    /// Writes the items of the first `length` columns, at least a vector of them, by the last three shears, the
    /// diagonal ones by quadratics of kind `Q`.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn run_by<L: Lanes, S: Quadratics<L>, Q: Quadratics<L>>(
        &mut self,
        length: usize,
        second: S,
    ) {
        let (columns, row, format) = (self.columns, self.row, *self.format);
        let [third_all, fourth_all] = [2, 3].map(|i| Tables::new(self.shears, i));
        let [third, fourth] = self.leads();
        let last = length - L::WIDTH;
        let mut places = [const { MaybeUninit::<[L::Ints; 2]>::uninit() }; PASS];
        let mut next = 0;
        while next < length {
            let pass = (length - next).div_ceil(L::WIDTH).min(PASS);
            // SAFETY: the machine has the instructions, and all slices have WIDTH values from each start on. The
            // last vector goes back over items that are already written.
            unsafe {
                let y = L::splat_int(row.y);
                for (k, place) in places[..pass].iter_mut().enumerate() {
                    let start = (next + k * L::WIDTH).min(last);
                    let third = Q::new(third_all, cell(columns.lattice[start], third));
                    let x = L::load_ints(columns.displaced.as_ptr().add(start));
                    let y = L::add_ints(L::load_ints(columns.displacements.as_ptr().add(start)), y);
                    let x = L::add_ints(x, noise(second, y));
                    let rising = noise(third, L::sub_ints(x, y));
                    place.write([L::add_ints(x, rising), L::add_ints(y, rising)]);
                }
                for (k, place) in places[..pass].iter().enumerate() {
                    let start = (next + k * L::WIDTH).min(last);
                    let lattice = &columns.lattice[start..start + L::WIDTH];
                    let fourth = Q::new(fourth_all, cell(lattice[0], fourth));
                    // Written above.
                    let [x, y] = place.assume_init();
                    let falling = noise(fourth, L::add_ints(x, y));
                    let position = [L::add_ints(x, falling), L::sub_ints(y, falling)];
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
    (extent, lattice): (Extent, &[i64]),
    displaced: &[i32],
    displacements: &mut [i32],
) {
    let mut columns = FirstShear {
        shears,
        extent,
        lattice,
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
    extent: Extent,
    lattice: &'a [i64],
    displaced: &'a [i32],
    displacements: &'a mut [i32],
}

impl VectorLoop for FirstShear<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let length = self.displaced.len().min(self.displacements.len());
        let length = length.min(self.lattice.len());
        let length = length - length % L::WIDTH;
        let width = self.extent.width::<L>();
        // SAFETY: as the caller ensures.
        unsafe {
            if fits(width, L::WINDOW) {
                self.run_by::<L, Near<L>>(length);
            } else if fits(width, PatchShears::AT_ONCE) {
                self.run_by::<L, AtOnce<L>>(length);
            } else {
                self.run_by::<L, Any<L>>(length);
            }
        }
        length
    }
}

impl FirstShear<'_> {
    /// Moves the first `length` columns, whole vectors.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn run_by<L: Lanes, Q: Quadratics<L>>(&mut self, length: usize) {
        let lead = self.extent.lead(self.extent.reach[0]);
        let tables = Tables::new(self.shears, 0);
        for start in (0..length).step_by(L::WIDTH) {
            // SAFETY: the machine has the instructions, and all slices have a vector from `start` on.
            unsafe {
                let quadratics = Q::new(tables, cell(self.lattice[start], lead));
                let to = self.displacements.as_mut_ptr().add(start);
                let moved =
                    noise::<L>(quadratics, L::load_ints(self.displaced.as_ptr().add(start)));
                L::store_ints(to, L::add_ints(L::load_ints(to), moved));
            }
        }
    }
}

/// Warps positions of points that follow each other: as [`warp_all`], with the cells of two vectors at a time.
pub(crate) fn warp_lists(backend: Backend, shears: &PatchShears, places: [&mut [i32]; 2]) {
    warp_in_passes(backend, shears, places, 2);
}

/// Warps positions: the x and y of all, whose number is a multiple of 32.
pub(crate) fn warp_all(backend: Backend, shears: &PatchShears, places: [&mut [i32]; 2]) {
    warp_in_passes(backend, shears, places, PASS);
}

fn warp_in_passes(backend: Backend, shears: &PatchShears, places: [&mut [i32]; 2], pass: usize) {
    let length = places[0].len();
    let mut all = WarpAll {
        shears,
        places: places.map(|list| &mut list[..length]),
        pass,
    };
    if run_vectors(backend, &mut all) < length {
        let [xs, ys] = all.places;
        for (x, y) in xs.iter_mut().zip(ys) {
            [*x, *y] = shears.apply(*x, *y);
        }
    }
}

/// Both slices have the same length.
struct WarpAll<'a> {
    shears: &'a PatchShears,
    places: [&'a mut [i32]; 2],
    /// The number of vectors whose cells are found together.
    pass: usize,
}

impl VectorLoop for WarpAll<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let length = self.places[0].len();
        if length == 0 || !length.is_multiple_of(L::WIDTH) {
            return 0;
        }
        // SAFETY: as the caller ensures, and parts lie within the slices.
        unsafe {
            let (mut size, mut all) = (self.pass * L::WIDTH, None);
            if self.pass == PASS {
                // The cells of all positions, if they are few enough to be found once.
                let known = self.cells::<L>(&(0..length));
                if known.1 == [L::WINDOW; 2] {
                    (size, all) = (length, Some(known));
                }
            }
            for next in (0..length).step_by(size) {
                let part = next..length.min(next + size);
                let (first, [axes, diagonals]) = match all {
                    Some(known) => known,
                    None => self.cells::<L>(&part),
                };
                if axes == L::WINDOW {
                    self.run_axes::<L, Near<L>>(&part, first);
                } else if axes == PatchShears::AT_ONCE {
                    self.run_axes::<L, AtOnce<L>>(&part, first);
                } else {
                    self.run_axes::<L, Any<L>>(&part, first);
                }
                if diagonals == L::WINDOW {
                    self.run_diagonals::<L, Near<L>>(&part, first);
                } else if diagonals == PatchShears::AT_ONCE {
                    self.run_diagonals::<L, AtOnce<L>>(&part, first);
                } else {
                    self.run_diagonals::<L, Any<L>>(&part, first);
                }
            }
        }
        length
    }
}

impl WarpAll<'_> {
    /// The first cells of the four shears that some positions touch, and the least number of cells known at once that has
    /// all of them, of those along the axes and of the diagonal ones; `usize::MAX` if none has.
    ///
    /// # Safety
    /// The machine has the instructions of `L`, and the part is one of whole vectors.
    #[inline(always)]
    unsafe fn cells<L: Lanes>(&self, part: &Range<usize>) -> ([i32; 4], [usize; 2]) {
        // Closures would be compiled without the instructions. SAFETY: as the caller ensures.
        let [x, y] = unsafe {
            [
                extent::<L>(&self.places[0][part.clone()]),
                extent::<L>(&self.places[1][part.clone()]),
            ]
        };
        let [along_y, along_x, rising, _] = self.shears.bounds;
        let more = |[a, b]: [i32; 2], [c, d]: [i32; 2]| [a + c, b + d];
        let (first, second) = (x, more(y, along_y));
        let x = more(x, along_x);
        let third = [x[0] - second[1], x[1] - second[0]];
        let fourth = [x[0] + second[0], x[1] + second[1]];
        let fourth = more(more(fourth, rising), rising);
        let width = |[least, most]: [i32; 2]| i64::from(most) - i64::from(least);
        let known = |ranges: [[i32; 2]; 2]| {
            let fit = |cells: &usize| ranges.map(width).iter().all(|&w| fits(w, *cells));
            let known = [L::WINDOW, PatchShears::AT_ONCE].into_iter().find(fit);
            known.unwrap_or(usize::MAX)
        };
        let ranges = [first, second, third, fourth];
        let cells = [known([first, second]), known([third, fourth])];
        (ranges.map(|range| range[0] >> CELL_BITS), cells)
    }
}

impl WarpAll<'_> {
    /// Moves some positions by the shears along the axes, whose first cells are known.
    ///
    /// # Safety
    /// The machine has the instructions of `L`, and the part is one of whole vectors.
    #[inline(always)]
    unsafe fn run_axes<L: Lanes, Q: Quadratics<L>>(
        &mut self,
        part: &Range<usize>,
        first: [i32; 4],
    ) {
        let [to_x, to_y] = &mut self.places;
        // SAFETY: the machine has the instructions, and all slices have a vector from each start on.
        unsafe {
            let along_y = Q::new(Tables::new(self.shears, 0), first[0]);
            let along_x = Q::new(Tables::new(self.shears, 1), first[1]);
            for start in part.clone().step_by(L::WIDTH) {
                let x = L::load_ints(to_x.as_ptr().add(start));
                let y = L::load_ints(to_y.as_ptr().add(start));
                let y = L::add_ints(y, noise(along_y, x));
                let x = L::add_ints(x, noise(along_x, y));
                L::store_ints(to_x.as_mut_ptr().add(start), x);
                L::store_ints(to_y.as_mut_ptr().add(start), y);
            }
        }
    }

    /// Moves some places by the diagonal shears, whose first cells are known.
    ///
    /// # Safety
    /// The machine has the instructions of `L`, and the part is one of whole vectors.
    #[inline(always)]
    unsafe fn run_diagonals<L: Lanes, Q: Quadratics<L>>(
        &mut self,
        part: &Range<usize>,
        first: [i32; 4],
    ) {
        let [to_x, to_y] = &mut self.places;
        // SAFETY: the machine has the instructions, and all slices have a vector from each start on.
        unsafe {
            let third = Q::new(Tables::new(self.shears, 2), first[2]);
            let fourth = Q::new(Tables::new(self.shears, 3), first[3]);
            for start in part.clone().step_by(L::WIDTH) {
                let x = L::load_ints(to_x.as_ptr().add(start));
                let y = L::load_ints(to_y.as_ptr().add(start));
                let rising = noise(third, L::sub_ints(x, y));
                let (x, y) = (L::add_ints(x, rising), L::add_ints(y, rising));
                let falling = noise(fourth, L::add_ints(x, y));
                L::store_ints(to_x.as_mut_ptr().add(start), L::add_ints(x, falling));
                L::store_ints(to_y.as_mut_ptr().add(start), L::sub_ints(y, falling));
            }
        }
    }
}

/// The least and the greatest of some numbers, whole vectors.
///
/// # Safety
/// The machine has the instructions of `L`, and there is at least a vector.
#[inline(always)]
unsafe fn extent<L: Lanes>(all: &[i32]) -> [i32; 2] {
    // SAFETY: as the caller ensures; the slice has a vector from each start on.
    unsafe {
        let mut least = L::load_ints(all.as_ptr());
        let mut most = least;
        for start in (L::WIDTH..all.len()).step_by(L::WIDTH) {
            let v = L::load_ints(all.as_ptr().add(start));
            (least, most) = (L::min_ints(least, v), L::max_ints(most, v));
        }
        let (least, most) = (stored::<L>(least), stored::<L>(most));
        let least = least[..L::WIDTH].iter().copied().fold(i32::MAX, i32::min);
        [
            least,
            most[..L::WIDTH].iter().copied().fold(i32::MIN, i32::max),
        ]
    }
}
