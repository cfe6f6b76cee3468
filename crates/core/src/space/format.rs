//! Output formats: how points become items.

use core::fmt::Debug;

use super::{
    Batch,
    lattice::fixed,
    point::{Point, PointId},
    scope::Scope,
};
use crate::{
    F32, F64, Offsets, Points,
    kernel::{
        Backend, Exactly, PlainLoop, below, compiled_loop, pick_pairs, pick_triples, write_triples,
    },
    table::FRACTION_BITS,
};

/// A format of points in space: [`F32`], [`F64`], [`Offsets`] or [`Points`]. The trait is sealed.
///
/// `F::Item` is what a block holds: `[f32; 3]` offsets from the plan's [origin](super::Plan::origin), `[f64; 3]` world
/// coordinates, as many offsets, or [`Point`].
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
    type Item: Copy + Default + Send + Debug + 'static;
    /// The part of an item that an offset along one axis decides.
    type Part: Copy + Default + Send + Debug + 'static;
    /// How offsets along an axis become parts.
    type Axis: Copy + Send + Debug + 'static;
    /// Whether addresses are needed.
    const HAS_IDS: bool = false;

    /// How offsets from a lattice coordinate become parts.
    fn axis(scope: &Scope, axis: usize, origin: i64) -> Self::Axis;

    /// The part of an offset.
    fn part(how: Self::Axis, offset: i32) -> Self::Part;

    /// The item of three parts and an address, if that is needed.
    fn item(parts: [Self::Part; 3], address: [i64; 3]) -> Self::Item;

    /// Writes the items of a row, as many as `out` has.
    fn pick(_: Backend, picks: Picks<'_, Self::Part>, out: &mut [Self::Item]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = picks.item::<Self>(i);
        }
    }

    /// Writes the items of some parts; there are as many of each.
    fn join(_: Backend, [x, y, z]: [&[Self::Part]; 3], out: &mut [Self::Item]) {
        for (((out, &x), &y), &z) in out.iter_mut().zip(x).zip(y).zip(z) {
            *out = Self::item([x, y, z], [0; 3]);
        }
    }
}

/// The points of a part of a row, whose numbers are picked by interval.
#[derive(Clone, Copy, Debug)]
pub struct Picks<'a, T> {
    /// Along x, for each point.
    pub(super) places: &'a [T],
    /// The intervals of dX.
    pub(super) blocks: &'a [u16],
    /// The lattice columns, relative to the first coordinate of the address, in fixed-point units.
    pub(super) columns: &'a [i32],
    /// Along y and z, for each interval.
    pub(super) across: [&'a [T]; 2],
    pub(super) address: [i64; 3],
}

impl<T: Copy> Picks<'_, T> {
    #[inline(always)]
    fn item<F: Emit<Part = T>>(&self, i: usize) -> F::Item {
        let block = usize::from(self.blocks[i]);
        let [y, z] = self.across.map(|parts| parts[block]);
        let [x, along_y, along_z] = self.address;
        let column = if F::HAS_IDS {
            self.columns[i] >> FRACTION_BITS
        } else {
            0
        };
        F::item(
            [self.places[i], y, z],
            [x + i64::from(column), along_y, along_z],
        )
    }

    /// Writes the items of the points whose intervals are inside. Returns their number; there is room for all.
    pub(super) fn write_inside<F: Emit<Part = T>>(
        &self,
        inside: &[bool],
        out: &mut [F::Item],
    ) -> usize {
        let ([ys, zs], [x, along_y, along_z]) = (self.across, self.address);
        let number = inside.len().min(ys.len()).min(zs.len());
        let (inside, ys, zs) = (&inside[..number], &ys[..number], &zs[..number]);
        let mut written = 0;
        for (i, (&place, &block)) in self.places.iter().zip(self.blocks).enumerate() {
            let block = usize::from(block);
            let column = if F::HAS_IDS {
                self.columns[i] >> FRACTION_BITS
            } else {
                0
            };
            let address = [x + i64::from(column), along_y, along_z];
            out[written] = F::item([place, ys[block], zs[block]], address);
            written += usize::from(inside[block]);
        }
        written
    }

    /// Writes the items of the points for which the test holds. Returns their number; there is room for all.
    pub(super) fn write_some<F: Emit<Part = T>>(
        &self,
        out: &mut [F::Item],
        test: impl Fn(usize) -> bool,
    ) -> usize {
        let mut written = 0;
        for i in 0..self.places.len() {
            out[written] = self.item::<F>(i);
            written += usize::from(test(i));
        }
        written
    }
}

/// The parts of the sums of a number and some others, offsets along an axis.
struct Conversion<'a, F: Emit> {
    how: F::Axis,
    lift: i32,
    offsets: &'a [i32],
    made: &'a mut [F::Part],
}

impl<F: Emit> PlainLoop for Conversion<'_, F> {
    #[inline(always)]
    fn run(&mut self) {
        let (how, lift) = (self.how, self.lift);
        for (made, &offset) in self.made.iter_mut().zip(self.offsets) {
            *made = F::part(how, lift + offset);
        }
    }
}

/// Finds the parts of the sums of a number and some others, offsets along an axis; there are as many of each.
pub(super) fn convert<F: Emit>(
    backend: Backend,
    how: F::Axis,
    (lift, offsets): (i32, &[i32]),
    made: &mut [F::Part],
) {
    let mut conversion = Conversion::<F> {
        how,
        lift,
        offsets,
        made,
    };
    compiled_loop(backend, &mut conversion);
}

/// Writes the points of a batch from a place on, as many as `out` has.
pub(super) fn write<F: Emit>(
    scope: &Scope,
    batch: &Batch,
    from: usize,
    backend: Backend,
    out: &mut [F::Item],
) {
    /// The number of points that are converted together.
    const PART: usize = 64;
    let how = [0, 1, 2].map(|axis| F::axis(scope, axis, batch.origin[axis]));
    let mut made = [[F::Part::default(); PART]; 3];
    for (number, out) in out.chunks_mut(PART).enumerate() {
        let from = from + number * PART;
        let length = out.len();
        for (axis, made) in made.iter_mut().enumerate() {
            let mut convert = Conversion::<F> {
                how: how[axis],
                lift: 0,
                offsets: &batch.places[axis][from..][..length],
                made: &mut made[..length],
            };
            compiled_loop(backend, &mut convert);
        }
        if !F::HAS_IDS {
            let [x, y, z] = &made;
            F::join(backend, [&x[..length], &y[..length], &z[..length]], out);
            continue;
        }
        for (i, (out, id)) in out.iter_mut().zip(&batch.ids[from..]).enumerate() {
            let address = [0, 1, 2].map(|axis| batch.origin[axis] + i64::from(id[axis]));
            *out = F::item([made[0][i], made[1][i], made[2][i]], address);
        }
    }
}

/// How an offset from an origin becomes a coordinate: ((base + offset) + lead) · step, at most `last`.
#[derive(Clone, Copy, Debug)]
pub struct Single {
    base: f64,
    lead: f64,
    step: f64,
    last: f32,
}

impl Format for F32 {}

impl Emit for F32 {
    type Item = [f32; 3];
    type Part = f32;
    type Axis = Single;

    fn axis(scope: &Scope, axis: usize, origin: i64) -> Single {
        let (corner, step) = (&scope.corner, scope.lattice.step);
        let [gap, error] = corner.gap[axis];
        Single {
            base: (fixed(origin) - corner.first[axis] as i64) as f64,
            lead: ((gap + error) / step).max(0.0),
            step,
            last: below(corner.extent[axis]),
        }
    }

    #[inline(always)]
    fn part(how: Single, offset: i32) -> f32 {
        let place = (((how.base + f64::from(offset)) + how.lead) * how.step) as f32;
        // Neither is NaN, so this is the minimum.
        if place < how.last { place } else { how.last }
    }

    #[inline(always)]
    fn item(parts: [f32; 3], _: [i64; 3]) -> [f32; 3] {
        parts
    }

    fn pick(backend: Backend, picks: Picks<'_, f32>, out: &mut [[f32; 3]]) {
        pick_triples(backend, picks.places, picks.blocks, picks.across, out);
    }

    fn join(backend: Backend, parts: [&[f32]; 3], out: &mut [[f32; 3]]) {
        write_triples(backend, parts, out);
    }
}

/// How an offset from an origin becomes a world coordinate: (base + offset) · step. Origins are whole lattice units, so
/// the sum is rounded once.
#[derive(Clone, Copy, Debug)]
pub struct Double {
    base: f64,
    step: f64,
}

impl Format for F64 {}

impl Emit for F64 {
    type Item = [f64; 3];
    type Part = f64;
    type Axis = Double;

    fn axis(scope: &Scope, _: usize, origin: i64) -> Double {
        Double {
            base: fixed(origin) as f64,
            step: scope.lattice.step,
        }
    }

    #[inline(always)]
    fn part(how: Double, offset: i32) -> f64 {
        (how.base + f64::from(offset)) * how.step
    }

    #[inline(always)]
    fn item(parts: [f64; 3], _: [i64; 3]) -> [f64; 3] {
        parts
    }

    fn pick(backend: Backend, picks: Picks<'_, f64>, out: &mut [[f64; 3]]) {
        pick_pairs(backend, picks.places, picks.blocks, picks.across, out);
    }
}

impl Format for Offsets {}

impl Emit for Offsets {
    type Item = [f64; 3];
    type Part = f64;
    /// Beside how offsets are rounded the distance of the origin from the anchor.
    type Axis = (Exactly, f64);

    fn axis(scope: &Scope, axis: usize, origin: i64) -> (Exactly, f64) {
        let (corner, step) = (&scope.corner, scope.lattice.step);
        let first = corner.first[axis] as i64;
        let exactly = Exactly::new(step, first.into(), corner.gap[axis], corner.extent[axis]);
        (exactly, fixed(origin - (first >> FRACTION_BITS)) as f64)
    }

    #[inline(always)]
    fn part((exactly, base): (Exactly, f64), offset: i32) -> f64 {
        exactly.place(base, offset)
    }

    #[inline(always)]
    fn item(parts: [f64; 3], _: [i64; 3]) -> [f64; 3] {
        parts
    }
}

impl Format for Points {}

impl Emit for Points {
    type Item = Point;
    type Part = f64;
    type Axis = Double;
    const HAS_IDS: bool = true;

    fn axis(scope: &Scope, axis: usize, origin: i64) -> Double {
        F64::axis(scope, axis, origin)
    }

    #[inline(always)]
    fn part(how: Double, offset: i32) -> f64 {
        F64::part(how, offset)
    }

    #[inline(always)]
    fn item([x, y, z]: [f64; 3], address: [i64; 3]) -> Point {
        let id = PointId::of(address);
        Point { id, x, y, z }
    }
}
