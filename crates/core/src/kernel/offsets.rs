//! Places as they are before any format rounds them, and `f64` coordinates relative to the corner of a region, rounded
//! once.

use super::format::{Emit, Geometry};
use crate::{
    lattice::PointId,
    table::{FRACTION_BITS, fixed},
};

/// Pairs of `f64` coordinates, or triples in space, relative to the region's lower corner
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
    axes: [Exactly; 2],
    /// The lattice coordinates at or below the first places inside.
    anchor: [i64; 2],
}

/// How exact offsets along an axis are rounded once: those of [`Offsets`], in the plane and in space.
///
/// ```
/// use strew_core::{Offsets, space::SpaceSet};
///
/// let plan = SpaceSet::blue().chunk(4.0, [0, 0, 0])?;
/// let mut offsets = vec![[0.0; 3]; plan.count() as usize];
/// plan.blocks::<Offsets>().fill(&mut offsets);
/// // In the first cube offsets are coordinates.
/// assert_eq!(offsets[0], plan.iter().next().map(|point| point.at()).unwrap_or_default());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Exactly {
    /// The step, and its upper and lower half.
    step: [f64; 3],
    /// The distance from the anchor, a lattice coordinate, to the first place inside, in fixed-point units.
    rest: f64,
    /// The distance from the corner to the first place, as a sum.
    gap: [f64; 2],
    /// The largest value.
    last: f64,
}

impl Exactly {
    /// Offsets from a corner that lies `gap` before `first`, the first fixed-point coordinate inside; below `extent`.
    pub(crate) fn new(step: f64, first: i128, gap: [f64; 2], extent: f64) -> Self {
        let (high, low) = halves(step);
        Self {
            step: [step, high, low],
            rest: (first & ((1 << FRACTION_BITS) - 1)) as f64,
            gap,
            last: extent.next_down().max(0.0),
        }
    }

    /// (base + offset)·step + gap, each operation with its rounding error, and the sum rounded once. The base is the
    /// distance from the anchor in fixed-point units.
    ///
    /// The sum and the product are the error-free ones of Knuth and of Dekker and Veltkamp ("A
    /// floating-point technique for extending the available precision", 1971).
    #[inline]
    pub(crate) fn place(&self, base: f64, offset: i32) -> f64 {
        let [step, high, low] = self.step;
        // Both are exact: integers below 2⁵³.
        let (units, rest) = sum(base, f64::from(offset) - self.rest);
        let (units_high, units_low) = halves(units);
        let product = units * step;
        let error =
            ((units_high * high - product) + units_high * low + units_low * high) + units_low * low;
        let [gap, gap_error] = self.gap;
        let (place, lost) = sum(product, gap);
        let place = place + (lost + (error + (rest * step + gap_error)));
        // None is NaN, so this is a clamp.
        if place > self.last {
            self.last
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

impl Emit for Offsets {
    type Item = [f64; 2];
    type Column = f64;

    fn new(geometry: &Geometry) -> Self {
        let Geometry {
            step,
            first,
            gap,
            extent,
            ..
        } = *geometry;
        Self {
            axes: [0, 1].map(|axis| Exactly::new(step, first[axis], gap[axis], extent[axis])),
            anchor: first.map(|first| (first >> FRACTION_BITS) as i64),
        }
    }

    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| fixed(origin[axis] - self.anchor[axis]) as f64)
    }

    #[inline]
    fn column(&self, base: [f64; 2], x: i32, _: i64) -> f64 {
        self.axes[0].place(base[0], x)
    }

    #[inline]
    fn item(&self, base: [f64; 2], x: f64, y: i32, _: i64) -> [f64; 2] {
        [x, self.axes[1].place(base[1], y)]
    }
}

/// Exact places with their ids, which [`Plan::converted`](crate::Plan::converted) turns into items of any other format.
///
/// The compiler copies the walks for each format that a program uses. A program that must be small uses this one alone.
///
/// ```
/// use strew_core::{Exact, F32, Place, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(8.0, [3, -2])?;
/// let (mut places, mut offsets) = ([Place::default(); 20], [[0.0; 2]; 20]);
/// plan.blocks::<Exact>().fill(&mut places);
/// plan.blocks_f32().fill(&mut offsets);
/// assert!(plan.converted::<F32>(&places).eq(offsets));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Exact;

/// The exact place of a point of a plan.
///
/// ```
/// use strew_core::{Exact, F64, Place, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(8.0, [3, -2])?;
/// let mut first = [Place::default()];
/// plan.blocks::<Exact>().fill(&mut first);
/// let at = plan.converted::<F64>(&first).next();
/// assert_eq!(at, plan.iter().next().map(|member| member.at()));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Place {
    id: PointId,
    /// The lattice address that `offset` is relative to.
    origin: [i64; 2],
    /// In fixed-point units.
    offset: [i32; 2],
}

impl Place {
    /// The id of the point.
    #[must_use]
    pub const fn id(&self) -> PointId {
        self.id
    }

    /// The item of a format.
    pub(crate) fn item<F: Emit>(&self, format: &F) -> F::Item {
        let base = format.base(self.origin);
        let [x, y] = self.offset;
        format.item(base, format.column(base, x, self.id.x), y, self.id.y)
    }
}

impl Emit for Exact {
    type Item = Place;
    /// The offset along x and the lattice column.
    type Column = (i32, i64);

    fn new(_: &Geometry) -> Self {
        Self
    }

    /// Lattice coordinates are exact in `f64`.
    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        origin.map(|v| v as f64)
    }

    #[inline]
    fn column(&self, _: [f64; 2], x: i32, column: i64) -> (i32, i64) {
        (x, column)
    }

    #[inline]
    fn item(&self, base: [f64; 2], (x, column): (i32, i64), y: i32, row: i64) -> Place {
        Place {
            id: PointId { x: column, y: row },
            origin: base.map(|v| v as i64),
            offset: [x, y],
        }
    }
}
