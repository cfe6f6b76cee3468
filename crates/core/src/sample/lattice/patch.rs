//! Bands and patches: pieces of the lattice in which positions fit 32 bits.
//!
//! A band is 1024 columns wide, a patch 256 rows of a band; both lie at multiples of these sizes. With
//! displacements below 128 grid units and the warp's reach, positions relative to the patch's origin,
//! their sums and their differences stay within 2³¹ units of 2⁻²⁰ grid units.

use alloc::boxed::Box;
use core::ops::Range;

use super::{Lattice, Span};
use crate::{
    pattern::Axis,
    sample::warp::{KNOT_BITS, PatchShears},
    table::{FRACTION_BITS, fixed},
};

/// The width of a band in lattice columns. Part of the order of points, so of the algorithm version.
pub(crate) const BAND_WIDTH: i64 = 1024;

/// The height of a patch in lattice rows.
pub(crate) const PATCH_HEIGHT: i64 = 256;

/// The columns of a band that lie in a range.
pub(crate) fn clip_to_band(band: i64, columns: &Range<i64>) -> Range<i64> {
    let start = band * BAND_WIDTH;
    columns.start.max(start)..columns.end.min(start + BAND_WIDTH)
}

/// The geometry that all points of a patch share.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    origin: [i64; 2],
    /// The number of rows.
    height: i64,
    /// The region, relative to the origin.
    bounds: [Range<i32>; 2],
    /// Whether all columns are inner ones.
    pub(crate) columns_are_inner: bool,
    shears: Option<Box<PatchShears>>,
    /// The least and the greatest displacement along x.
    reach: [i32; 2],
}

impl Patch {
    /// The patch of a band that contains a row.
    pub(crate) fn new(lattice: &Lattice, band: i64, row: i64, x: &Span, y: &Span) -> Self {
        let reach = [Axis::X, Axis::Y].map(|axis| lattice.table_reach(axis));
        Self::with_reach(lattice, [band, row], [x, y], reach)
    }

    /// The patch of a band that contains a row, with the least and the greatest displacement along x and y.
    pub(crate) fn with_reach(
        lattice: &Lattice,
        [band, row]: [i64; 2],
        [x, y]: [&Span; 2],
        reach: [[i32; 2]; 2],
    ) -> Self {
        let origin = [band * BAND_WIDTH, row & !(PATCH_HEIGHT - 1)];
        Self::at(lattice, (origin, PATCH_HEIGHT), [x, y], reach)
    }

    /// A patch of twice the height, from a row on or some before it.
    pub(crate) fn tall(lattice: &Lattice, [band, row]: [i64; 2], spans: [&Span; 2]) -> Self {
        let origin = [band * BAND_WIDTH, row & !((1 << KNOT_BITS) - 1)];
        let reach = [Axis::X, Axis::Y].map(|axis| lattice.table_reach(axis));
        Self::at(lattice, (origin, 2 * PATCH_HEIGHT), spans, reach)
    }

    fn at(
        lattice: &Lattice,
        (origin, height): ([i64; 2], i64),
        [x, y]: [&Span; 2],
        reach: [[i32; 2]; 2],
    ) -> Self {
        let relative = |span: &Span, origin: i64| {
            // A bound beyond 32 bits is beyond every point of the patch.
            let clamp =
                |k: i128| (k - fixed(origin)).clamp(i32::MIN.into(), i32::MAX.into()) as i32;
            clamp(span.bounds.start)..clamp(span.bounds.end)
        };
        Self {
            origin,
            height,
            bounds: [relative(x, origin[0]), relative(y, origin[1])],
            columns_are_inner: x.inner.start <= origin[0] && origin[0] + BAND_WIDTH <= x.inner.end,
            reach: reach[0],
            shears: lattice.shears.map(|shears| {
                let ranges =
                    [(Axis::X, x, BAND_WIDTH), (Axis::Y, y, height)].map(|(axis, span, length)| {
                        let origin = origin[axis as usize];
                        let [least, most] = reach[axis as usize];
                        let first = span.all.start.clamp(origin, origin + length) - origin;
                        let end = span.all.end.clamp(origin, origin + length) - origin;
                        let fixed = |v: i64| (v << FRACTION_BITS) as i32;
                        [fixed(first) + least, fixed(end - 1) + most]
                    });
                Box::new(PatchShears::new(&shears, origin, ranges))
            }),
        }
    }

    /// The address of the lower left corner.
    pub(crate) const fn origin(&self) -> [i64; 2] {
        self.origin
    }

    /// The first row above the patch.
    pub(crate) const fn end(&self) -> i64 {
        self.origin[1] + self.height
    }

    /// Whether there is a warp.
    pub(crate) const fn is_warped(&self) -> bool {
        self.shears.is_some()
    }

    /// The warp, if there is one.
    pub(crate) fn shears(&self) -> Option<&PatchShears> {
        self.shears.as_deref()
    }

    /// The least and the greatest displacement along x.
    pub(crate) const fn reach(&self) -> [i32; 2] {
        self.reach
    }

    /// The place of a displaced position, both relative to the origin.
    #[inline(always)]
    pub(crate) fn place(&self, displaced: [i32; 2]) -> [i32; 2] {
        let [x, y] = displaced;
        self.shears().map_or(displaced, |shears| shears.apply(x, y))
    }

    /// The least and the greatest movement by the warp of the points of some columns and rows of the patch, which
    /// are not empty, along x and y.
    pub(crate) fn drift(&self, lattice: &Lattice, piece: &[Range<i64>; 2]) -> [[i32; 2]; 2] {
        let (Some(own), Some(shears)) = (self.shears(), &lattice.shears) else {
            return [[0; 2]; 2];
        };
        let ends = [Axis::X, Axis::Y].map(|axis| {
            let range = &piece[axis as usize];
            let [least, most] = lattice.table_reach(axis);
            let relative = |v: i64| self.relative(axis, v);
            [
                relative(range.start) + least,
                relative(range.end - 1) + most,
            ]
        });
        own.drift(shears, ends)
    }

    /// A lattice row or column of the patch, relative to the origin.
    pub(crate) const fn relative(&self, axis: Axis, v: i64) -> i32 {
        ((v - self.origin[axis as usize]) << FRACTION_BITS) as i32
    }

    /// Whether a relative coordinate lies inside the region.
    #[inline(always)]
    pub(crate) fn holds_along(&self, axis: Axis, v: i32) -> bool {
        self.bounds[axis as usize].contains(&v)
    }

    /// The region, relative to the origin.
    pub(crate) const fn bounds(&self) -> &[Range<i32>; 2] {
        &self.bounds
    }

    /// Whether a relative position lies inside the region.
    #[inline(always)]
    pub(crate) fn holds(&self, [x, y]: [i32; 2]) -> bool {
        self.bounds[0].contains(&x) && self.bounds[1].contains(&y)
    }
}
