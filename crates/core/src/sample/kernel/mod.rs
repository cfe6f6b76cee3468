//! The innermost loops: a row is a template of its columns plus the row's place.
//!
//! What is written here in plain code is the definition of every output format; any faster path
//! must give the same bits.

use super::{Point, PointId, fixed, plan::Plan};

/// An output format: what a column contributes once per template, what a row contributes, and how
/// the two make an item.
pub trait Format: Copy + Send + core::fmt::Debug + 'static + sealed::Sealed {
    /// What is written for a point.
    type Item: Copy + Default + Send + 'static;
    /// A column of a template.
    #[doc(hidden)]
    type Column: Copy + Send + core::fmt::Debug + 'static;
    /// A row's share.
    #[doc(hidden)]
    type Row: Copy;

    #[doc(hidden)]
    fn new(plan: &Plan) -> Self;
    #[doc(hidden)]
    fn column(&self, x: i64, displacement: i32) -> Self::Column;
    #[doc(hidden)]
    fn row(&self, y: i64) -> Self::Row;
    #[doc(hidden)]
    fn item(&self, column: Self::Column, row: Self::Row, displacement: i32) -> Self::Item;

    /// What a tile contributes to the items of a warped plane.
    #[doc(hidden)]
    type Base: Copy;
    #[doc(hidden)]
    fn base(&self, origin: [i64; 2]) -> Self::Base;
    /// The item of a fixed-point position relative to the tile's origin.
    #[doc(hidden)]
    fn at(&self, base: Self::Base, position: [i32; 2], id: PointId) -> Self::Item;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::F32 {}
    impl Sealed for super::F64 {}
    impl Sealed for super::Points {}
}

/// Writes one item per column.
pub(super) fn emit<F: Format>(
    format: &F,
    row: F::Row,
    columns: &[F::Column],
    displacements: &[i32],
    out: &mut [F::Item],
) {
    for ((item, &column), &displacement) in out.iter_mut().zip(columns).zip(displacements) {
        *item = format.item(column, row, displacement);
    }
}

/// Pairs of `f64` world coordinates.
#[derive(Clone, Copy, Debug)]
pub struct F64 {
    step: f64,
}

impl F64 {
    /// The world coordinate of a lattice coordinate (as an exact `f64` in fixed point) and its
    /// displacement. The sum is rounded once, as the integer sum's conversion would be: both terms
    /// are exact while lattice coordinates stay below 2⁵³.
    fn place(&self, base: f64, displacement: i32) -> f64 {
        (base + f64::from(displacement)) * self.step
    }
}

impl Format for F64 {
    type Item = [f64; 2];
    type Column = f64;
    type Row = f64;

    fn new(plan: &Plan) -> Self {
        Self {
            step: plan.frame.step,
        }
    }

    fn column(&self, x: i64, displacement: i32) -> f64 {
        self.place(fixed(x) as f64, displacement)
    }

    fn row(&self, y: i64) -> f64 {
        fixed(y) as f64
    }

    #[inline(always)]
    fn item(&self, x: f64, row: f64, displacement: i32) -> [f64; 2] {
        [x, self.place(row, displacement)]
    }

    type Base = [f64; 2];

    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        origin.map(|v| fixed(v) as f64)
    }

    #[inline(always)]
    fn at(&self, base: [f64; 2], [x, y]: [i32; 2], _: PointId) -> [f64; 2] {
        [self.place(base[0], x), self.place(base[1], y)]
    }
}

/// Points with ids, in `f64` world coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Points(F64);

impl Format for Points {
    type Item = Point;
    type Column = (i64, f64);
    type Row = (i64, f64);

    fn new(plan: &Plan) -> Self {
        Self(F64::new(plan))
    }

    fn column(&self, x: i64, displacement: i32) -> (i64, f64) {
        (x, self.0.column(x, displacement))
    }

    fn row(&self, y: i64) -> (i64, f64) {
        (y, self.0.row(y))
    }

    #[inline(always)]
    fn item(&self, (id_x, x): (i64, f64), (id_y, row): (i64, f64), displacement: i32) -> Point {
        Point {
            id: PointId { x: id_x, y: id_y },
            x,
            y: self.0.place(row, displacement),
        }
    }

    type Base = [f64; 2];

    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        self.0.base(origin)
    }

    #[inline(always)]
    fn at(&self, base: [f64; 2], position: [i32; 2], id: PointId) -> Point {
        let [x, y] = self.0.at(base, position, id);
        Point { id, x, y }
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

impl Format for F32 {
    type Item = [f32; 2];
    type Column = f32;
    type Row = f64;

    fn new(plan: &Plan) -> Self {
        let (min, max) = (plan.region().min(), plan.region().max());
        Self {
            step: plan.frame.step,
            first: [plan.x.bounds.start, plan.y.bounds.start],
            last: [0, 1].map(|i| below(max[i] - min[i])),
        }
    }

    fn column(&self, x: i64, displacement: i32) -> f32 {
        let base = (fixed(x) - self.first[0]) as f64;
        self.place(0, base, displacement)
    }

    fn row(&self, y: i64) -> f64 {
        (fixed(y) - self.first[1]) as f64
    }

    #[inline(always)]
    fn item(&self, x: f32, row: f64, displacement: i32) -> [f32; 2] {
        [x, self.place(1, row, displacement)]
    }

    type Base = [f64; 2];

    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| (fixed(origin[axis]) - self.first[axis]) as f64)
    }

    #[inline(always)]
    fn at(&self, base: [f64; 2], [x, y]: [i32; 2], _: PointId) -> [f32; 2] {
        [self.place(0, base[0], x), self.place(1, base[1], y)]
    }
}

impl F32 {
    #[inline(always)]
    fn place(&self, axis: usize, base: f64, displacement: i32) -> f32 {
        (((base + f64::from(displacement)) * self.step) as f32).min(self.last[axis])
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
