//! Lanes: the vector operations that the row loops need, as one small trait, and the loops over them.

use crate::lattice::Point;

/// Vectors of one instruction set: [`WIDTH`](Self::WIDTH) integers, singles or doubles, in as many
/// registers as that takes.
///
/// # Safety
/// All functions require a machine with the instruction set, which
/// [`Backend::available`](super::Backend::available) ensures. Those that take pointers require
/// [`WIDTH`](Self::WIDTH) values there; pointers need no alignment.
pub trait Lanes: Sized {
    /// The number of lanes.
    const WIDTH: usize;
    /// The number of successive cells that a [`Table`](Self::Table) has, at most
    /// [`AT_ONCE`](crate::warp::PatchShears::AT_ONCE).
    const WINDOW: usize;

    /// `i32` lanes.
    type Ints: Copy;
    /// `f32` lanes.
    type Singles: Copy;
    /// `f64` lanes.
    type Doubles: Copy;
    /// The coefficients of [`WINDOW`](Self::WINDOW) successive cells.
    type Table: Copy;

    unsafe fn load_ints(from: *const i32) -> Self::Ints;
    unsafe fn store_ints(to: *mut i32, v: Self::Ints);
    unsafe fn splat_int(v: i32) -> Self::Ints;
    unsafe fn add_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints;
    unsafe fn sub_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints;
    unsafe fn min_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints;
    unsafe fn max_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints;
    /// Lattice coordinates in fixed point: `v << FRACTION_BITS`.
    unsafe fn fixed(v: Self::Ints) -> Self::Ints;
    /// The cells of coordinates: `v >> CELL_BITS`.
    unsafe fn cells(v: Self::Ints) -> Self::Ints;
    /// The places of coordinates in their cells: `v & PatchShears::CELL_MASK`.
    unsafe fn places(v: Self::Ints) -> Self::Ints;

    unsafe fn load_singles(from: *const f32) -> Self::Singles;
    unsafe fn splat_single(v: f32) -> Self::Singles;
    unsafe fn add_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles;
    unsafe fn mul_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles;
    /// `if a < b { a } else { b }`
    unsafe fn min_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles;
    unsafe fn singles_of(v: Self::Ints) -> Self::Singles;
    /// Rounds toward zero.
    unsafe fn truncate(v: Self::Singles) -> Self::Ints;
    /// A table of the [`WINDOW`](Self::WINDOW) coefficients there.
    unsafe fn table(from: *const f32) -> Self::Table;
    /// The coefficients at some places of a table.
    unsafe fn pick(table: Self::Table, places: Self::Ints) -> Self::Singles;
    /// The coefficients at some places below [`AT_ONCE`](crate::warp::PatchShears::AT_ONCE), as many as are
    /// there.
    unsafe fn pick_at_once(from: *const f32, places: Self::Ints) -> Self::Singles;

    /// The coefficients at any places.
    ///
    /// # Safety
    /// There are coefficients at all of them.
    #[inline(always)]
    unsafe fn gather(from: *const f32, places: Self::Ints) -> Self::Singles {
        // SAFETY: as the caller ensures.
        unsafe {
            let places = stored::<Self>(places);
            let mut picked = [0.0; MOST];
            for (picked, &place) in picked.iter_mut().zip(&places).take(Self::WIDTH) {
                *picked = *from.add(place as usize);
            }
            Self::load_singles(picked.as_ptr())
        }
    }

    /// The lanes of numbers that were integers in memory.
    unsafe fn bits_of(v: Self::Singles) -> Self::Ints;

    unsafe fn load_doubles(from: *const f64) -> Self::Doubles;
    unsafe fn splat_double(v: f64) -> Self::Doubles;
    unsafe fn add_doubles(a: Self::Doubles, b: Self::Doubles) -> Self::Doubles;
    unsafe fn mul_doubles(a: Self::Doubles, b: Self::Doubles) -> Self::Doubles;
    unsafe fn doubles_of(v: Self::Ints) -> Self::Doubles;
    /// The sums of some integers and `y`, as doubles.
    unsafe fn offsets(from: *const i32, y: i32) -> Self::Doubles;
    /// Rounds to nearest.
    unsafe fn narrow(v: Self::Doubles) -> Self::Singles;

    /// Stores x and y of each lane side by side.
    unsafe fn store_single_pairs(to: *mut [f32; 2], x: Self::Singles, y: Self::Singles);
    /// Stores x and y of each lane side by side.
    unsafe fn store_double_pairs(to: *mut [f64; 2], x: Self::Doubles, y: Self::Doubles);

    /// Stores the `f32` places of a pair of offsets in each lane: (base + offset)·step, rounded to `f32`, at most
    /// `last`.
    #[inline(always)]
    unsafe fn store_single_places(
        to: *mut [f32; 2],
        offsets: [Self::Ints; 2],
        (base, step, last): ([f64; 2], f64, [f32; 2]),
    ) {
        // SAFETY: as the caller ensures.
        unsafe {
            let step = Self::splat_double(step);
            let mut places = [Self::splat_single(last[0]), Self::splat_single(last[1])];
            for axis in 0..2 {
                let offset = Self::doubles_of(offsets[axis]);
                let place = Self::add_doubles(Self::splat_double(base[axis]), offset);
                let place = Self::narrow(Self::mul_doubles(place, step));
                places[axis] = Self::min_singles(place, places[axis]);
            }
            Self::store_single_pairs(to, places[0], places[1]);
        }
    }

    /// Stores the `f64` places of a pair of offsets in each lane: (base + offset)·step.
    #[inline(always)]
    unsafe fn store_double_places(
        to: *mut [f64; 2],
        offsets: [Self::Ints; 2],
        (base, step): ([f64; 2], f64),
    ) {
        // SAFETY: as the caller ensures.
        unsafe {
            let step = Self::splat_double(step);
            let mut places = [step; 2];
            for axis in 0..2 {
                let offset = Self::doubles_of(offsets[axis]);
                let place = Self::add_doubles(Self::splat_double(base[axis]), offset);
                places[axis] = Self::mul_doubles(place, step);
            }
            Self::store_double_pairs(to, places[0], places[1]);
        }
    }

    /// Whether there are [`between`](Self::between) and [`compress`](Self::compress).
    const HAS_COMPRESS: bool = false;

    /// A bit for each lane from `least` to before `end`.
    unsafe fn between(v: Self::Ints, least: i32, end: i32) -> u32 {
        let _ = (v, least, end);
        unreachable!("HAS_COMPRESS is false");
    }
    /// The lanes whose bits are set, moved to the front.
    unsafe fn compress(v: Self::Ints, mask: u32) -> Self::Ints {
        let _ = (v, mask);
        unreachable!("HAS_COMPRESS is false");
    }

    /// Whether there are [`two_tables`](Self::two_tables) and the functions after it.
    const HAS_TRIPLES: bool = false;

    /// The 32 numbers there.
    unsafe fn two_tables(from: *const f32) -> [Self::Singles; 2] {
        let _ = from;
        unreachable!("HAS_TRIPLES is false");
    }
    /// The lanes of places.
    unsafe fn load_places(from: *const u16) -> Self::Ints {
        let _ = from;
        unreachable!("HAS_TRIPLES is false");
    }
    /// The numbers at some places, modulo 32, of two tables.
    unsafe fn pick_of_two(tables: [Self::Singles; 2], places: Self::Ints) -> Self::Singles {
        let _ = (tables, places);
        unreachable!("HAS_TRIPLES is false");
    }
    /// Stores the three numbers of each lane side by side.
    unsafe fn store_single_triples(to: *mut [f32; 3], parts: [Self::Singles; 3]) {
        let _ = (to, parts);
        unreachable!("HAS_TRIPLES is false");
    }

    /// Whether [`store_points`](Self::store_points) is faster than plain code.
    const HAS_POINTS: bool = false;

    /// Stores points: their columns and the bits of their x by turns, their common row, and their y.
    unsafe fn store_points(to: *mut Point, columns: *const [u64; 2], row: i64, y: Self::Doubles) {
        let _ = (to, columns, row, y);
        unreachable!("HAS_POINTS is false");
    }
}

/// The most lanes of a vector.
const MOST: usize = 16;

/// The lanes of a vector, followed by zeros.
///
/// # Safety
/// The machine has the instructions of `L`.
#[inline(always)]
pub(super) unsafe fn stored<L: Lanes>(v: L::Ints) -> [i32; MOST] {
    const { assert!(L::WIDTH <= MOST) };
    let mut lanes = [0; MOST];
    // SAFETY: as the caller ensures, and the array holds at least WIDTH values.
    unsafe { L::store_ints(lanes.as_mut_ptr(), v) };
    lanes
}

/// A loop over vectors, written once for all instruction sets.
pub(super) trait VectorLoop {
    /// Writes items from the front in whole vectors. Returns the number written: all of them, or none if
    /// there are fewer than fill a vector.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    unsafe fn run<L: Lanes>(&mut self) -> usize;
}

/// A loop of plain code, too long to be inlined by itself. Implementations of `run` are inlined always.
pub(crate) trait PlainLoop {
    /// Runs all of it.
    fn run(&mut self);
}
