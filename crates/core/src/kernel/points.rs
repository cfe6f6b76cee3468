//! The formats of most requests: world coordinates in `f64`, as pairs or as points with ids, and pairs of `f32` relative
//! to the corner of a region.

use super::{
    format::{Emit, Geometry, Row},
    lanes::Lanes,
    listing::vector_starts,
};
use crate::{
    lattice::{Point, PointId},
    table::fixed,
};

/// Pairs of `f64` world coordinates.
///
/// ```
/// use strew_core::{F64, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(8.0, [3, -2])?;
/// let mut block = [[0.0; 2]; 100];
/// let filled = plan.blocks::<F64>().fill(&mut block);
/// let points = plan.iter().map(|member| member.at());
/// assert!(points.eq(block[..filled].iter().copied()));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct F64 {
    pub(super) step: f64,
}

impl F64 {
    #[inline(always)]
    fn place(&self, base: f64, offset: i32) -> f64 {
        (base + f64::from(offset)) * self.step
    }

    /// The places of a vector of offsets.
    ///
    /// # Safety
    /// The machine has the instructions of `L`.
    #[inline(always)]
    unsafe fn places<L: Lanes>(&self, base: f64, offsets: L::Doubles) -> L::Doubles {
        // SAFETY: as the caller ensures.
        unsafe {
            let place = L::add_doubles(L::splat_double(base), offsets);
            L::mul_doubles(place, L::splat_double(self.step))
        }
    }
}

impl Emit for F64 {
    type Item = [f64; 2];
    type Column = f64;

    fn new(geometry: &Geometry) -> Self {
        Self {
            step: geometry.step,
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

    #[inline(always)]
    unsafe fn vector_row<L: Lanes>(
        &self,
        row: Row,
        columns: &[f64],
        displacements: &[i32],
        out: &mut [[f64; 2]],
    ) -> usize {
        let length = out.len().min(columns.len()).min(displacements.len());
        // SAFETY: the machine has the instructions, and WIDTH values from `i` on lie within all slices.
        unsafe {
            for i in vector_starts::<L>(length) {
                let offsets = L::offsets(displacements.as_ptr().add(i), row.y);
                let y = self.places::<L>(row.base[1], offsets);
                let x = L::load_doubles(columns.as_ptr().add(i));
                L::store_double_pairs(out.as_mut_ptr().add(i), x, y);
            }
        }
        if length < L::WIDTH { 0 } else { length }
    }

    #[inline(always)]
    unsafe fn vector_items<L: Lanes>(
        &self,
        row: Row,
        position: [L::Ints; 2],
        _: &[i64],
        out: &mut [[f64; 2]],
    ) {
        debug_assert_eq!(out.len(), L::WIDTH);
        // SAFETY: the machine has the instructions, and `out` has WIDTH items.
        unsafe {
            L::store_double_places(out.as_mut_ptr(), position, (row.base, self.step));
        }
    }
}

/// Points with ids, in `f64` world coordinates.
///
/// ```
/// use strew_core::{Point, PointSet, Points, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(8.0, [3, -2])?;
/// let mut block = [Point::default(); 100];
/// let filled = plan.blocks::<Points>().fill(&mut block);
/// assert_eq!(block[..filled], plan.to_vec());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Points(pub(super) F64);

impl Emit for Points {
    type Item = Point;
    /// The lattice column, and the bits of x.
    type Column = [u64; 2];

    fn new(geometry: &Geometry) -> Self {
        Self(F64::new(geometry))
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

    #[inline(always)]
    unsafe fn vector_row<L: Lanes>(
        &self,
        row: Row,
        columns: &[[u64; 2]],
        displacements: &[i32],
        out: &mut [Point],
    ) -> usize {
        let length = out.len().min(columns.len()).min(displacements.len());
        if !L::HAS_POINTS || length < L::WIDTH {
            return 0;
        }
        // SAFETY: the machine has the instructions, and WIDTH values from `i` on lie within all slices.
        unsafe {
            for i in vector_starts::<L>(length) {
                let offsets = L::offsets(displacements.as_ptr().add(i), row.y);
                let y = self.0.places::<L>(row.base[1], offsets);
                let (to, columns) = (out.as_mut_ptr().add(i), columns.as_ptr().add(i));
                L::store_points(to, columns, row.lattice, y);
            }
        }
        length
    }
}

/// Pairs of `f32` coordinates relative to the region's lower corner
/// ([`Plan::origin`](crate::Plan::origin)).
///
/// The offset is computed in `f64`, from exact integers, and rounded once to `f32`. A chunk's corner is the exact
/// multiple of its size, at any distance from the origin. In a region that is no chunk, reported coordinates decide
/// what lies inside: where they round the first place up to the corner, offsets are from that place. What would round
/// up to the region's extent becomes the largest `f32` below it, so relative coordinates lie in \[0, extent).
///
/// ```
/// use strew_core::{F32, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// // A chunk so far out that `f32` world coordinates would be 64 units apart.
/// let plan = PointSet::new(table).chunk(8.0, [100_000_000, 0])?;
/// let mut block = [[0.0; 2]; 100];
/// let filled = plan.blocks::<F32>().fill(&mut block);
/// assert!(block[..filled].iter().flatten().all(|offset| (0.0..8.0).contains(offset)));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct F32 {
    pub(super) step: f64,
    /// The first place inside.
    pub(super) first: [i128; 2],
    /// The distance from the corner to that place, in steps.
    pub(super) lead: [f64; 2],
    /// The largest value per axis.
    pub(super) last: [f32; 2],
}

impl F32 {
    #[inline(always)]
    fn place(&self, axis: usize, base: f64, offset: i32) -> f32 {
        let place = ((base + f64::from(offset)) * self.step) as f32;
        let last = self.last[axis];
        // Neither is NaN, so this is the minimum.
        if place < last { place } else { last }
    }
}

impl Emit for F32 {
    type Item = [f32; 2];
    type Column = f32;

    fn new(geometry: &Geometry) -> Self {
        Self {
            step: geometry.step,
            first: geometry.first,
            lead: geometry
                .gap
                .map(|[gap, error]| ((gap + error) / geometry.step).max(0.0)),
            last: geometry.extent.map(below),
        }
    }

    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| (fixed(origin[axis]) - self.first[axis]) as f64 + self.lead[axis])
    }

    #[inline(always)]
    fn column(&self, base: [f64; 2], x: i32, _: i64) -> f32 {
        self.place(0, base[0], x)
    }

    #[inline(always)]
    fn item(&self, base: [f64; 2], x: f32, y: i32, _: i64) -> [f32; 2] {
        [x, self.place(1, base[1], y)]
    }

    #[inline(always)]
    unsafe fn vector_row<L: Lanes>(
        &self,
        row: Row,
        columns: &[f32],
        displacements: &[i32],
        out: &mut [[f32; 2]],
    ) -> usize {
        let length = out.len().min(columns.len()).min(displacements.len());
        // SAFETY: the machine has the instructions, and WIDTH values from `i` on lie within all slices.
        unsafe {
            let (base, step) = (L::splat_double(row.base[1]), L::splat_double(self.step));
            let last = L::splat_single(self.last[1]);
            for i in vector_starts::<L>(length) {
                let offset = L::offsets(displacements.as_ptr().add(i), row.y);
                let y = L::narrow(L::mul_doubles(L::add_doubles(base, offset), step));
                let x = L::load_singles(columns.as_ptr().add(i));
                L::store_single_pairs(out.as_mut_ptr().add(i), x, L::min_singles(y, last));
            }
        }
        if length < L::WIDTH { 0 } else { length }
    }

    #[inline(always)]
    unsafe fn vector_items<L: Lanes>(
        &self,
        row: Row,
        position: [L::Ints; 2],
        _: &[i64],
        out: &mut [[f32; 2]],
    ) {
        debug_assert_eq!(out.len(), L::WIDTH);
        // SAFETY: the machine has the instructions, and `out` has WIDTH items.
        unsafe {
            let how = (row.base, self.step, self.last);
            L::store_single_places(out.as_mut_ptr(), position, how);
        }
    }
}

/// The largest `f32` below a positive extent, or 0 if there is none.
pub(crate) fn below(extent: f64) -> f32 {
    let nearest = extent as f32;
    if f64::from(nearest) < extent {
        nearest
    } else {
        nearest.next_down().max(0.0)
    }
}
