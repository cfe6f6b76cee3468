//! Boxes on the grid of fixed-point coordinates, in the plane and in space: the bounds of requested points, and the
//! corner that their offsets are relative to.

use core::ops::Range;

use super::Multiple;
use crate::{
    error::{Error, ErrorKind, exponential, number},
    shape::{Chunk, Region},
};

/// The fixed-point coordinates of a box.
pub(crate) type Bounds<const D: usize> = [Range<i128>; D];

/// The place that offsets of points are relative to, on the fixed-point grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner<const D: usize> {
    /// The place in world coordinates, rounded.
    pub(crate) at: [f64; D],
    /// The first fixed-point coordinates from there on.
    pub(crate) first: [i128; D],
    /// The distances from the exact place to [`first`](Self::first); see [`Multiple::gap`].
    pub(crate) gap: [[f64; 2]; D],
    /// Offsets are below this.
    pub(crate) extent: [f64; D],
}

impl<const D: usize> Corner<D> {
    /// The exact corner of the last one of some chunks, or else the lower corner of a box with these bounds.
    pub(crate) fn new(
        step: f64,
        chunks: &[Chunk<D>],
        region: &Region<D>,
        bounds: &Bounds<D>,
    ) -> Self {
        if let Some(Chunk { size, at }) = chunks.last() {
            let multiples = at.map(|index| Multiple::new(step, *size, index));
            return Self {
                at: at.map(|index| index as f64 * size),
                first: multiples.map(|multiple| multiple.first),
                gap: multiples.map(|multiple| multiple.gap),
                extent: [*size; D],
            };
        }
        let (min, max) = (region.min(), region.max());
        let first = bounds.each_ref().map(|range| range.start);
        let gap = |axis: usize| {
            let sign = if min[axis] < 0.0 { -1 } else { 1 };
            let corner = Multiple::new(step, min[axis].abs(), sign);
            // Reported coordinates decide which is first, so it is a little beside the corner far out.
            let [gap, error] = corner.gap;
            [gap, error + world(step, first[axis] - corner.first)]
        };
        Self {
            at: min,
            first,
            gap: core::array::from_fn(gap),
            extent: core::array::from_fn(|axis| max[axis] - min[axis]),
        }
    }
}

/// The fixed-point coordinates of the points of an area along its axes: of its chunks exactly, of the box around
/// everything else by the reported coordinates. The area is within the limit.
pub(crate) fn bounds<const D: usize>(
    (step, limit): (f64, f64),
    chunks: &[Chunk<D>],
    rest: Option<Region<D>>,
) -> Bounds<D> {
    let of_box = rest.map(|region| {
        let end = |bound: f64| first_at_or_above(step, bound.clamp(-limit, limit));
        core::array::from_fn(|axis| end(region.min()[axis])..end(region.max()[axis]))
    });
    let of_chunks = chunks.iter().map(|chunk| {
        chunk.at.map(|index| {
            let first = |index| Multiple::new(step, chunk.size, index).first;
            first(index)..first(index + 1)
        })
    });
    let all = of_box.into_iter().chain(of_chunks);
    all.reduce(|a, b| common_box(&a, &b))
        .unwrap_or([const { 0..0 }; D])
}

/// Refuses a box that reaches beyond the limit of a lattice.
pub(crate) fn check_limit<const D: usize>(region: &Region<D>, limit: f64) -> Result<(), Error> {
    match region.numbers().find(|(_, value)| value.abs() > limit) {
        Some((name, value)) => {
            let allowed = alloc::format!(
                "within ±{} with this spacing, where f64 coordinates still keep neighbors apart",
                exponential(limit)
            );
            let error = Error::new(ErrorKind::TooFar, name, number(value), allowed);
            Err(error.because("too far from the origin").with_limit(limit))
        }
        None => Ok(()),
    }
}

/// The part that two ranges have in common.
pub(crate) fn common<T: Copy + Ord>(a: &Range<T>, b: &Range<T>) -> Range<T> {
    let start = a.start.max(b.start);
    start..a.end.min(b.end).max(start)
}

/// The part that two boxes have in common.
pub(crate) fn common_box<T: Copy + Ord, const D: usize>(
    a: &[Range<T>; D],
    b: &[Range<T>; D],
) -> [Range<T>; D] {
    core::array::from_fn(|axis| common(&a[axis], &b[axis]))
}

/// Kept out of line, or both conversions would become the slow one.
#[cold]
#[inline(never)]
fn wide(fixed: i128) -> f64 {
    fixed as f64
}

/// The world coordinate of a fixed-point one. Monotone.
#[inline]
pub(crate) fn world(step: f64, fixed: i128) -> f64 {
    // Conversions from 64 bits are faster, and round alike.
    let fixed = match i64::try_from(fixed) {
        Ok(fixed) => fixed as f64,
        Err(_) => wide(fixed),
    };
    fixed * step
}

/// The least fixed-point coordinate whose world coordinate is ≥ `bound`, for a bound within the
/// limit. Exact: a bisection on the conversion itself.
pub(crate) fn first_at_or_above(step: f64, bound: f64) -> i128 {
    let reaches = |k: i128| world(step, k) >= bound;
    let guess = (bound / step) as i128;
    let mut width = 2i128;
    let (mut low, mut high) = (guess - 1, guess + 1);
    while reaches(low) {
        low -= width;
        width *= 2;
    }
    while !reaches(high) {
        high += width;
        width *= 2;
    }
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if reaches(middle) {
            high = middle
        } else {
            low = middle
        }
    }
    high
}
