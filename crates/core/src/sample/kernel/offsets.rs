//! Pairs of `f64` relative to the corner of a region, rounded once.

use super::{
    Format,
    format::{Emit, Geometry, Row},
    lanes::{Lanes, stored},
};
use crate::table::{FRACTION_BITS, fixed};

/// Pairs of `f64` coordinates relative to the region's lower corner
/// ([`Plan::origin`](crate::Plan::origin)).
///
/// The offset of the exact position from the corner is rounded once, so offsets are as precise at any
/// distance as at the origin. A chunk's corner is the exact multiple of its size. Offsets lie in
/// \[0, extent): what would round up to the extent becomes the number below it. In a region that is no
/// chunk they can also reach below 0 before they are rounded, by half of what the reported coordinates
/// resolve there, and become 0.
///
/// ```
/// use strew_core::{F64, Offsets, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(8.0, [1_000_000_000_000, 0])?;
/// let (mut offsets, mut places) = ([[0.0; 2]; 20], [[0.0; 2]; 20]);
/// plan.blocks::<Offsets>().fill(&mut offsets);
/// plan.blocks::<F64>().fill(&mut places);
/// for (offset, place) in offsets.iter().zip(places) {
///     // World coordinates are multiples of 2⁻¹⁰ there, offsets are not.
///     let difference = offset[0] - (place[0] - plan.origin()[0]);
///     assert!(difference != 0.0 && difference.abs() < 1e-3);
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Offsets {
    /// The step, and its upper and lower half.
    step: [f64; 3],
    /// The lattice coordinates at or below the first places inside.
    anchor: [i64; 2],
    /// The distances from there to the first places.
    rest: [f64; 2],
    gap: [[f64; 2]; 2],
    /// The largest value per axis.
    last: [f64; 2],
}

impl Offsets {
    /// (base + offset)·step + gap, each operation with its rounding error, and the sum rounded once.
    ///
    /// The sum and the product are the error-free ones of Knuth and of Dekker and Veltkamp ("A
    /// floating-point technique for extending the available precision", 1971).
    #[inline]
    fn place(&self, axis: usize, base: f64, offset: i32) -> f64 {
        let [step, high, low] = self.step;
        // Both are exact: integers below 2⁵³.
        let (units, rest) = sum(base, f64::from(offset) - self.rest[axis]);
        let (units_high, units_low) = halves(units);
        let product = units * step;
        let error =
            ((units_high * high - product) + units_high * low + units_low * high) + units_low * low;
        let [gap, gap_error] = self.gap[axis];
        let (place, lost) = sum(product, gap);
        let place = place + (lost + (error + (rest * step + gap_error)));
        let last = self.last[axis];
        // None is NaN, so this is a clamp.
        if place > last {
            last
        } else if place > 0.0 {
            place
        } else {
            0.0
        }
    }
}

/// A sum and its rounding error.
#[inline]
fn sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// A number as the sum of two of at most 26 bits.
#[inline]
fn halves(v: f64) -> (f64, f64) {
    const SPLIT: f64 = 134_217_729.0;
    let scaled = SPLIT * v;
    let high = scaled - (scaled - v);
    (high, v - high)
}

impl Format for Offsets {}

impl Emit for Offsets {
    type Item = [f64; 2];
    type Column = f64;

    fn new(geometry: &Geometry) -> Self {
        let (high, low) = halves(geometry.step);
        Self {
            step: [geometry.step, high, low],
            anchor: geometry.first.map(|first| (first >> FRACTION_BITS) as i64),
            rest: geometry
                .first
                .map(|first| (first & ((1 << FRACTION_BITS) - 1)) as f64),
            gap: geometry.gap,
            last: geometry.extent.map(|extent| extent.next_down().max(0.0)),
        }
    }

    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| fixed(origin[axis] - self.anchor[axis]) as f64)
    }

    #[inline]
    fn column(&self, base: [f64; 2], x: i32, _: i64) -> f64 {
        self.place(0, base[0], x)
    }

    #[inline]
    fn item(&self, base: [f64; 2], x: f64, y: i32, _: i64) -> [f64; 2] {
        [x, self.place(1, base[1], y)]
    }

    #[inline(always)]
    unsafe fn vector_items<L: Lanes>(
        &self,
        row: Row,
        position: [L::Ints; 2],
        lattice: &[i64],
        out: &mut [[f64; 2]],
    ) {
        // SAFETY: the machine has the instructions.
        let [xs, ys] = position.map(|v| unsafe { stored::<L>(v) });
        for (out, ((x, y), &column)) in out.iter_mut().zip(xs.into_iter().zip(ys).zip(lattice)) {
            let column = self.column(row.base, x, column);
            *out = self.item(row.base, column, y, row.lattice);
        }
    }
}
