//! Quadratics: how lanes look up the coefficients of their cells in the tables of a shear.

use super::lanes::Lanes;
use crate::warp::PatchShears;

/// The quadratics of some cells of a direction, in a form in which coordinates find theirs.
pub(super) trait Quadratics<L: Lanes>: Copy {
    /// The quadratics of a direction from a cell on.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    unsafe fn new(tables: Tables, first: i32) -> Self;

    /// The coefficients of the cells of coordinates: constant, linear, square.
    ///
    /// # Safety
    /// The machine has the instructions of `L`, and the tables are still there.
    unsafe fn of(self, s: L::Ints) -> [L::Singles; 3];
}

/// g of coordinates across a direction; see [`PatchShears`].
///
/// # Safety
/// The machine has the instructions of `L`, and the tables are still there.
#[inline(always)]
pub(super) unsafe fn noise<L: Lanes>(quadratics: impl Quadratics<L>, s: L::Ints) -> L::Ints {
    // SAFETY: as the caller ensures.
    unsafe {
        let [constant, linear, square] = quadratics.of(s);
        let at = L::singles_of(L::places(s));
        let value = L::add_singles(L::mul_singles(square, at), linear);
        L::truncate(L::add_singles(L::mul_singles(value, at), constant))
    }
}

/// The tables of a direction. A copy on the stack, which loops keep in registers.
#[derive(Clone, Copy)]
pub(super) struct Tables {
    from: *const f32,
    /// The length of a table.
    length: usize,
    /// The first cell.
    first: i32,
    /// The place of the last one.
    last: u32,
}

impl Tables {
    #[inline(always)]
    pub(super) fn new(shears: &PatchShears, direction: usize) -> Self {
        let (tables, length) = shears.tables(direction);
        // From the last place on each of the three has as many entries.
        assert!(tables.len() == 3 * length && shears.last_place() + PatchShears::AT_ONCE == length);
        Self {
            from: tables.as_ptr(),
            length,
            first: shears.first[direction],
            last: shears.last_place() as u32,
        }
    }

    /// The three tables from a cell on, and the number of that cell. They have at least [`PatchShears::AT_ONCE`]
    /// entries left.
    #[inline(always)]
    fn at(self, cell: i32) -> ([*const f32; 3], i32) {
        let place = ((cell - self.first) as u32).min(self.last);
        let here = self.from.wrapping_add(place as usize);
        let from = [0, 1, 2].map(|power| here.wrapping_add(power * self.length));
        (from, self.first + place as i32)
    }
}

/// The coefficients of [`Lanes::WINDOW`] cells.
pub(super) struct Near<L: Lanes> {
    tables: [L::Table; 3],
    first: L::Ints,
}

/// The coefficients of [`PatchShears::AT_ONCE`] cells.
pub(super) struct AtOnce<L: Lanes> {
    from: [*const f32; 3],
    first: L::Ints,
}

/// The coefficients of all cells.
pub(super) struct Any<L: Lanes> {
    from: [*const f32; 3],
    first: L::Ints,
    last: L::Ints,
}

impl<L: Lanes> Clone for Near<L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lanes> Copy for Near<L> {}

impl<L: Lanes> Clone for AtOnce<L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lanes> Copy for AtOnce<L> {}

impl<L: Lanes> Clone for Any<L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lanes> Copy for Any<L> {}

impl<L: Lanes> Quadratics<L> for Near<L> {
    #[inline(always)]
    unsafe fn new(tables: Tables, first: i32) -> Self {
        const { assert!(L::WINDOW <= PatchShears::AT_ONCE) };
        let (from, first) = tables.at(first);
        // SAFETY: the machine has the instructions, and the tables as many entries.
        unsafe {
            Self {
                tables: [L::table(from[0]), L::table(from[1]), L::table(from[2])],
                first: L::splat_int(first),
            }
        }
    }

    #[inline(always)]
    unsafe fn of(self, s: L::Ints) -> [L::Singles; 3] {
        let [constant, linear, square] = self.tables;
        // SAFETY: as the caller ensures.
        unsafe {
            let places = L::sub_ints(L::cells(s), self.first);
            [
                L::pick(constant, places),
                L::pick(linear, places),
                L::pick(square, places),
            ]
        }
    }
}

impl<L: Lanes> Quadratics<L> for AtOnce<L> {
    #[inline(always)]
    unsafe fn new(tables: Tables, first: i32) -> Self {
        let (from, first) = tables.at(first);
        // SAFETY: the machine has the instructions.
        let first = unsafe { L::splat_int(first) };
        Self { from, first }
    }

    #[inline(always)]
    unsafe fn of(self, s: L::Ints) -> [L::Singles; 3] {
        let [constant, linear, square] = self.from;
        // SAFETY: the machine has the instructions, and the tables as many entries.
        unsafe {
            let places = L::sub_ints(L::cells(s), self.first);
            [
                L::pick_at_once(constant, places),
                L::pick_at_once(linear, places),
                L::pick_at_once(square, places),
            ]
        }
    }
}

impl<L: Lanes> Quadratics<L> for Any<L> {
    #[inline(always)]
    unsafe fn new(tables: Tables, _: i32) -> Self {
        let (from, first) = tables.at(tables.first);
        // SAFETY: the machine has the instructions.
        unsafe {
            Self {
                from,
                first: L::splat_int(first),
                last: L::splat_int(tables.last as i32),
            }
        }
    }

    #[inline(always)]
    unsafe fn of(self, s: L::Ints) -> [L::Singles; 3] {
        let [constant, linear, square] = self.from;
        // SAFETY: the machine has the instructions, and places are brought into the tables.
        unsafe {
            let last = self.last;
            let places = L::sub_ints(L::cells(s), self.first);
            let places = L::min_ints(L::max_ints(places, L::splat_int(0)), last);
            [
                L::gather(constant, places),
                L::gather(linear, places),
                L::gather(square, places),
            ]
        }
    }
}
