//! Patches: pieces of the lattice small enough for 32-bit positions.
//!
//! A patch is one band wide and 256 rows high, at multiples of both. With displacements below 128
//! grid units and the warp's reach, positions relative to its origin and their sums and differences
//! stay within 2³¹ units of 2⁻²⁰ grid units.

use alloc::boxed::Box;
use core::ops::Range;

use super::{Frame, fixed, plan::Span, warp::PatchShears};
use crate::{pattern::Axis, table::FRACTION_BITS};

/// How many lattice columns a band has. Part of the order of points, so of the algorithm version.
pub(super) const BAND_WIDTH: i64 = 1024;

/// How many lattice rows a patch has.
pub(super) const PATCH_HEIGHT: i64 = 256;

/// What stays the same within a patch.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    origin: [i64; 2],
    /// The region, relative to the origin.
    bounds: [Range<i32>; 2],
    /// Whether all of its columns are inner ones.
    pub(super) columns_are_inner: bool,
    shears: Option<Box<PatchShears>>,
}

impl Patch {
    /// The patch that holds a row of a band.
    pub(super) fn new(frame: &Frame, band: i64, row: i64, x: &Span, y: &Span) -> Self {
        let origin = [band * BAND_WIDTH, row & !(PATCH_HEIGHT - 1)];
        let relative = |span: &Span, origin: i64| {
            // A bound beyond 32 bits is beyond every point of the patch.
            let clamp =
                |k: i128| (k - fixed(origin)).clamp(i32::MIN.into(), i32::MAX.into()) as i32;
            clamp(span.bounds.start)..clamp(span.bounds.end)
        };
        Self {
            origin,
            bounds: [relative(x, origin[0]), relative(y, origin[1])],
            columns_are_inner: x.inner.start <= origin[0] && origin[0] + BAND_WIDTH <= x.inner.end,
            shears: frame
                .shears
                .map(|shears| Box::new(PatchShears::new(&shears, origin))),
        }
    }

    pub(super) const fn origin(&self) -> [i64; 2] {
        self.origin
    }

    /// The first row above the patch.
    pub(super) const fn end(&self) -> i64 {
        self.origin[1] + PATCH_HEIGHT
    }

    /// Whether there is a warp.
    pub(super) const fn is_warped(&self) -> bool {
        self.shears.is_some()
    }

    /// The warp, if there is one.
    pub(super) fn shears(&self) -> Option<&PatchShears> {
        self.shears.as_deref()
    }

    /// Where a displaced position, relative to the origin, ends up.
    #[inline(always)]
    pub(super) fn place(&self, displaced: [i32; 2]) -> [i32; 2] {
        let [x, y] = displaced;
        self.shears().map_or(displaced, |shears| shears.apply(x, y))
    }

    /// A lattice row or column of the patch, relative to the origin.
    pub(super) const fn relative(&self, axis: Axis, v: i64) -> i32 {
        ((v - self.origin[axis as usize]) << FRACTION_BITS) as i32
    }

    /// Whether a relative coordinate is inside the region.
    #[inline(always)]
    pub(super) fn holds_along(&self, axis: Axis, v: i32) -> bool {
        self.bounds[axis as usize].contains(&v)
    }

    #[inline(always)]
    pub(super) fn holds(&self, [x, y]: [i32; 2]) -> bool {
        self.bounds[0].contains(&x) && self.bounds[1].contains(&y)
    }
}
