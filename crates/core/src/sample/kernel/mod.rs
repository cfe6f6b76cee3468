//! The innermost loops: a row is a template of its columns plus the row's place.
//!
//! What is written here in plain code is the definition of every output format; a faster path must
//! give the same bits. Positions are 32-bit fixed-point offsets from a tile's origin, which is
//! exact in `f64`; their sum is rounded once, as the conversion of the whole integer would be,
//! while lattice coordinates stay below 2⁵³.

#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[expect(
    unsafe_code,
    reason = "vector loads and stores by pointer, bounds checked before"
)]
mod avx2;
#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[expect(
    unsafe_code,
    reason = "vector loads and stores by pointer, masked to the bounds"
)]
mod avx512;
mod backend;
#[cfg_attr(
    all(feature = "std", target_arch = "x86_64"),
    expect(
        unsafe_code,
        reason = "a backend is only ever named where the machine has it"
    )
)]
pub(super) mod compiled;
mod shear;
#[cfg(test)]
mod tests;

use super::{Point, PointId, fixed, plan::Plan, warp::PatchShears};

pub use backend::Backend;
pub(super) use shear::{Columns, warped_row};

/// An output format: how a position becomes an item, the part along x first, since a template
/// keeps it for all rows.
pub trait Format: Copy + Send + core::fmt::Debug + 'static + sealed::Sealed {
    /// What is written for a point.
    type Item: Copy + Default + Send + 'static;
    /// What a column of a template contributes.
    #[doc(hidden)]
    type Column: Copy + Send + core::fmt::Debug + 'static;

    #[doc(hidden)]
    fn new(plan: &Plan) -> Self;
    /// The place of a tile's origin.
    #[doc(hidden)]
    fn base(&self, origin: [i64; 2]) -> [f64; 2];
    /// The share of a point's x: its offset from the tile's origin and its lattice column.
    #[doc(hidden)]
    fn column(&self, base: [f64; 2], x: i32, column: i64) -> Self::Column;
    /// The item: the same for y.
    #[doc(hidden)]
    fn item(&self, base: [f64; 2], column: Self::Column, y: i32, row: i64) -> Self::Item;

    /// One item per column of a row.
    #[doc(hidden)]
    fn fill_row(
        &self,
        _: Backend,
        row: Row,
        columns: &[Self::Column],
        displacements: &[i32],
        out: &mut [Self::Item],
    ) {
        emit(self, row, columns, displacements, out);
    }

    /// As many of a warped row's items as fill whole vectors; gives how many.
    #[doc(hidden)]
    fn warp_row(
        &self,
        backend: Backend,
        shears: &PatchShears,
        row: Row,
        columns: Columns<'_>,
        out: &mut [Self::Item],
    ) -> usize {
        shear::whole_vectors(self, backend, shears, row, columns, out)
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::F32 {}
    impl Sealed for super::F64 {}
    impl Sealed for super::Points {}
}

/// A lattice row of a tile: where it is, and its offset from the tile's origin.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub(super) base: [f64; 2],
    pub(super) y: i32,
    pub(super) lattice: i64,
}

/// Writes one item per column: the definition.
#[inline(always)]
fn emit<F: Format>(
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

/// Pairs of `f64` world coordinates.
#[derive(Clone, Copy, Debug)]
pub struct F64 {
    step: f64,
}

impl F64 {
    #[inline(always)]
    fn place(&self, base: f64, offset: i32) -> f64 {
        (base + f64::from(offset)) * self.step
    }
}

impl Format for F64 {
    type Item = [f64; 2];
    type Column = f64;

    fn new(plan: &Plan) -> Self {
        Self {
            step: plan.frame.step,
        }
    }

    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        origin.map(|v| fixed(v) as f64)
    }

    #[inline(always)]
    fn column(&self, base: [f64; 2], x: i32, _: i64) -> f64 {
        self.place(base[0], x)
    }

    #[inline(always)]
    fn item(&self, base: [f64; 2], x: f64, y: i32, _: i64) -> [f64; 2] {
        [x, self.place(base[1], y)]
    }

    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    #[expect(
        unsafe_code,
        reason = "a backend is only ever made where the machine has it"
    )]
    fn fill_row(
        &self,
        backend: Backend,
        row: Row,
        columns: &[Self::Column],
        displacements: &[i32],
        out: &mut [Self::Item],
    ) {
        let scale = (row.base[1], self.step);
        let done = match backend {
            Backend::Scalar => 0,
            // SAFETY: `Backend::available` has found the instructions.
            Backend::Avx2 => unsafe { avx2::f64_row(scale, row.y, columns, displacements, out) },
            Backend::Avx512 => {
                // SAFETY: `Backend::available` has found the instructions.
                return unsafe { avx512::f64_row(scale, row.y, columns, displacements, out) };
            }
        };
        emit(
            self,
            row,
            &columns[done..],
            &displacements[done..],
            &mut out[done..],
        );
    }
}

/// Points with ids, in `f64` world coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Points(F64);

impl Format for Points {
    type Item = Point;
    /// The lattice column, and the bits of x.
    type Column = [u64; 2];

    fn new(plan: &Plan) -> Self {
        Self(F64::new(plan))
    }

    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        self.0.base(origin)
    }

    #[inline(always)]
    fn column(&self, base: [f64; 2], x: i32, column: i64) -> [u64; 2] {
        [column as u64, self.0.place(base[0], x).to_bits()]
    }

    #[inline(always)]
    fn item(&self, base: [f64; 2], [column, x]: [u64; 2], y: i32, row: i64) -> Point {
        Point {
            id: PointId {
                x: column as i64,
                y: row,
            },
            x: f64::from_bits(x),
            y: self.0.place(base[1], y),
        }
    }

    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    #[expect(
        unsafe_code,
        reason = "a backend is only ever made where the machine has it"
    )]
    fn fill_row(
        &self,
        backend: Backend,
        row: Row,
        columns: &[Self::Column],
        displacements: &[i32],
        out: &mut [Self::Item],
    ) {
        let done = match backend {
            // SAFETY: `Backend::available` has found the instructions.
            Backend::Avx512 => unsafe {
                avx512::points_row(self.0.step, row, columns, displacements, out)
            },
            _ => 0,
        };
        let rest = columns.get(done..).unwrap_or_default();
        let displacements = displacements.get(done..).unwrap_or_default();
        emit(self, row, rest, displacements, &mut out[done..]);
    }
}

/// Pairs of `f32` coordinates relative to the region's lower corner ([`Plan::origin`]).
///
/// The offset from the first fixed-point place inside the region is exact in integers, then scaled
/// in `f64` and rounded once to `f32`; what would round up to the region's extent takes the largest
/// `f32` below it, so relative coordinates are in \[0, extent) too.
#[derive(Clone, Copy, Debug)]
pub struct F32 {
    step: f64,
    /// The first place inside.
    first: [i128; 2],
    /// The largest value per axis.
    last: [f32; 2],
}

impl F32 {
    #[inline(always)]
    fn place(&self, axis: usize, base: f64, offset: i32) -> f32 {
        let (place, last) = (
            ((base + f64::from(offset)) * self.step) as f32,
            self.last[axis],
        );
        // Neither is NaN: `min` would ask.
        if place < last { place } else { last }
    }
}

impl Format for F32 {
    type Item = [f32; 2];
    type Column = f32;

    fn new(plan: &Plan) -> Self {
        let (min, max) = (plan.region().min(), plan.region().max());
        Self {
            step: plan.frame.step,
            first: [plan.x.bounds.start, plan.y.bounds.start],
            last: [0, 1].map(|i| below(max[i] - min[i])),
        }
    }

    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| (fixed(origin[axis]) - self.first[axis]) as f64)
    }

    #[inline(always)]
    fn column(&self, base: [f64; 2], x: i32, _: i64) -> f32 {
        self.place(0, base[0], x)
    }

    #[inline(always)]
    fn item(&self, base: [f64; 2], x: f32, y: i32, _: i64) -> [f32; 2] {
        [x, self.place(1, base[1], y)]
    }

    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    #[expect(
        unsafe_code,
        reason = "a backend is only ever made where the machine has it"
    )]
    fn fill_row(
        &self,
        backend: Backend,
        row: Row,
        columns: &[Self::Column],
        displacements: &[i32],
        out: &mut [Self::Item],
    ) {
        let scale = (row.base[1], self.step, self.last[1]);
        let done = match backend {
            Backend::Scalar => 0,
            // SAFETY: `Backend::available` has found the instructions.
            Backend::Avx2 => unsafe { avx2::f32_row(scale, row.y, columns, displacements, out) },
            Backend::Avx512 => {
                // SAFETY: `Backend::available` has found the instructions.
                return unsafe { avx512::f32_row(scale, row.y, columns, displacements, out) };
            }
        };
        emit(
            self,
            row,
            &columns[done..],
            &displacements[done..],
            &mut out[done..],
        );
    }

    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    #[expect(
        unsafe_code,
        reason = "a backend is only ever made where the machine has it"
    )]
    fn warp_row(
        &self,
        backend: Backend,
        shears: &PatchShears,
        row: Row,
        columns: Columns<'_>,
        out: &mut [Self::Item],
    ) -> usize {
        if backend == Backend::Avx512 {
            let places = (self.step, self.last);
            // SAFETY: `Backend::available` has found the instructions.
            return unsafe { avx512::warped_f32_row(places, shears, row, columns, out) };
        }
        shear::whole_vectors(self, backend, shears, row, columns, out)
    }
}

/// The largest `f32` below a positive extent; 0 if there is none.
fn below(extent: f64) -> f32 {
    let nearest = extent as f32;
    if f64::from(nearest) < extent {
        nearest
    } else {
        nearest.next_down().max(0.0)
    }
}
