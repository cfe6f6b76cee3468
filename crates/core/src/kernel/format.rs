//! Output formats: how the position of a point becomes an item.

use core::fmt::Debug;

use super::lanes::{Lanes, stored};

/// The geometry of a plan, as formats need it.
#[derive(Clone, Copy, Debug)]
pub struct Geometry {
    /// World units per fixed-point unit.
    pub(crate) step: f64,
    /// The first fixed-point coordinates from the corner on that offsets are relative to.
    pub(crate) first: [i128; 2],
    /// The distances from the corner to these in world units, each as a number and its rounding error.
    pub(crate) gap: [[f64; 2]; 2],
    /// Offsets are below this.
    pub(crate) extent: [f64; 2],
}

/// A lattice row of a patch.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// [`Emit::base`] of the patch.
    pub(crate) base: [f64; 2],
    /// Relative to the patch's origin.
    pub(crate) y: i32,
    /// The lattice coordinate.
    pub(crate) lattice: i64,
}

/// The definition of a format. The part along x comes first, since a template keeps it for all rows.
pub trait Emit: Copy + Send + Debug + 'static {
    /// The item that is written for a point.
    type Item: Copy + Default + Send + 'static;
    /// The part of an item that its column decides.
    type Column: Copy + Send + Debug + 'static;

    fn new(geometry: &Geometry) -> Self;

    /// The place of a patch's origin.
    fn base(&self, origin: [i64; 2]) -> [f64; 2];

    /// The part of an item that its column decides: `x` is relative to the patch's origin, `column` the lattice column.
    fn column(&self, base: [f64; 2], x: i32, column: i64) -> Self::Column;

    /// The item of a column and a `y` relative to the patch's origin; `row` is the lattice row.
    fn item(&self, base: [f64; 2], column: Self::Column, y: i32, row: i64) -> Self::Item;

    /// Writes the items of a row in whole vectors. Returns the number written: all, or none, and plain code writes them.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn vector_row<L: Lanes>(
        &self,
        _row: Row,
        _columns: &[Self::Column],
        _displacements: &[i32],
        _out: &mut [Self::Item],
    ) -> usize {
        0
    }

    /// Writes one vector of items at positions relative to the patch's origin. `lattice` and `out` have
    /// [`Lanes::WIDTH`] entries.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn vector_items<L: Lanes>(
        &self,
        row: Row,
        position: [L::Ints; 2],
        lattice: &[i64],
        out: &mut [Self::Item],
    ) {
        // SAFETY: the machine has the instructions.
        let [xs, ys] = position.map(|v| unsafe { stored::<L>(v) });
        for (out, ((x, y), &column)) in out.iter_mut().zip(xs.into_iter().zip(ys).zip(lattice)) {
            let column = self.column(row.base, x, column);
            *out = self.item(row.base, column, y, row.lattice);
        }
    }
}
