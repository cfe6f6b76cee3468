//! Output formats: how points become items.

use core::fmt::Debug;

use super::{
    batch::Batch,
    lattice::fixed,
    point::{Point, PointId},
    scope::Scope,
};
use crate::{
    F32, F64, Points,
    sample::{Backend, space::compiled},
};

/// A format of points in space: [`F32`], [`F64`] or [`Points`]. The trait is sealed.
///
/// `F::Item` is what a block holds: `[f32; 3]` offsets from the plan's [origin](super::Plan::origin), `[f64; 3]` world
/// coordinates, or [`Point`].
///
/// ```
/// use strew_core::{F32, F64, Points, space::{Format, Plan, SpaceSet, Table}};
///
/// fn first<F: Format>(plan: &Plan) -> F::Item {
///     let mut block = [F::Item::default()];
///     plan.blocks::<F>().fill(&mut block);
///     block[0]
/// }
///
/// let plan = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).chunk(8.0, [0, 0, 0])?;
/// let at = first::<F64>(&plan);
/// assert_eq!(first::<F32>(&plan), at.map(|v| v as f32));
/// assert_eq!(first::<Points>(&plan).at(), at);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub trait Format: Emit {}

/// The definition of a format.
pub trait Emit: Copy + Send + Debug + 'static {
    /// The item that is written for a point.
    type Item: Copy + Default + Send + 'static;
    /// Whether addresses are needed.
    const HAS_IDS: bool;

    /// Writes the points of a batch from a place on, as many as `out` has.
    fn write(scope: &Scope, batch: &Batch, from: usize, backend: Backend, out: &mut [Self::Item]);
}

/// How an offset from a batch's origin becomes a coordinate: ((base + offset) + lead) · step, at most `last`.
#[derive(Clone, Copy)]
struct Single {
    base: f64,
    lead: f64,
    step: f64,
    last: f32,
}

impl Single {
    fn new(scope: &Scope, batch: &Batch, axis: usize) -> Self {
        let corner = &scope.corner;
        Self {
            base: (fixed(batch.origin[axis]) - corner.first[axis]) as f64,
            lead: corner.lead[axis],
            step: scope.lattice.step,
            last: below(corner.extent[axis]),
        }
    }

    #[inline(always)]
    fn of(self, offset: i32) -> f32 {
        let place = (((self.base + f64::from(offset)) + self.lead) * self.step) as f32;
        // Neither is NaN, so this is the minimum.
        if place < self.last { place } else { self.last }
    }
}

/// The largest `f32` below a positive extent, or 0 if there is none.
fn below(extent: f64) -> f32 {
    let nearest = extent as f32;
    if f64::from(nearest) < extent {
        nearest
    } else {
        nearest.next_down().max(0.0)
    }
}

impl Format for F32 {}

impl Emit for F32 {
    type Item = [f32; 3];
    const HAS_IDS: bool = false;

    fn write(scope: &Scope, batch: &Batch, from: usize, backend: Backend, out: &mut [[f32; 3]]) {
        let axes = [0, 1, 2].map(|axis| Single::new(scope, batch, axis));
        let places = [0, 1, 2].map(|axis| &batch.places[axis][from..][..out.len()]);
        compiled(backend, || {
            in_parts(out, places, |axis, offset| axes[axis].of(offset))
        });
    }
}

/// Writes the points of some lists, part by part: the places of a part axis by axis, then side by side.
#[inline(always)]
fn in_parts<T: Copy + Default>(
    out: &mut [[T; 3]],
    places: [&[i32]; 3],
    place: impl Fn(usize, i32) -> T,
) {
    /// The number of points of a part.
    const PART: usize = 64;
    let whole = out.len() - out.len() % PART;
    let (parts, rest) = out.split_at_mut(whole);
    let mut made = [[T::default(); PART]; 3];
    for (number, part) in parts.chunks_exact_mut(PART).enumerate() {
        for axis in 0..3 {
            let from = &places[axis][number * PART..][..PART];
            for (made, &offset) in made[axis].iter_mut().zip(from) {
                *made = place(axis, offset);
            }
        }
        for (i, out) in part.iter_mut().enumerate() {
            *out = [made[0][i], made[1][i], made[2][i]];
        }
    }
    for (i, out) in (whole..).zip(rest) {
        *out = [0, 1, 2].map(|axis| place(axis, places[axis][i]));
    }
}

impl Format for F64 {}

impl Emit for F64 {
    type Item = [f64; 3];
    const HAS_IDS: bool = false;

    fn write(scope: &Scope, batch: &Batch, from: usize, backend: Backend, out: &mut [[f64; 3]]) {
        let step = scope.lattice.step;
        // Origins are whole lattice units, so their sums with offsets are rounded once.
        let origin = batch.origin.map(|origin| fixed(origin) as f64);
        let places = [0, 1, 2].map(|axis| &batch.places[axis][from..][..out.len()]);
        compiled(backend, || {
            in_parts(out, places, |axis, offset| {
                (origin[axis] + f64::from(offset)) * step
            });
        });
    }
}

impl Format for Points {}

impl Emit for Points {
    type Item = Point;
    const HAS_IDS: bool = true;

    fn write(scope: &Scope, batch: &Batch, from: usize, _: Backend, out: &mut [Point]) {
        for (i, out) in (from..).zip(out) {
            let id = [0, 1, 2].map(|axis| batch.origin[axis] + i64::from(batch.ids[i][axis]));
            let place =
                [0, 1, 2].map(|axis| fixed(batch.origin[axis]) + i64::from(batch.places[axis][i]));
            *out = scope.lattice.point_at(PointId::of(id), place);
        }
    }
}
