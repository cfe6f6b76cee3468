//! One step: all pushes of neighbors on the points that move.
//!
//! # Sums in any order
//!
//! Two windows that have a point list its neighbors in different orders, with different points beyond its reach. The
//! point must go to the same place in both, so its sum of pushes must not depend on the order. Places are integers, in
//! units of a window, that `f32` holds exactly, and so are their differences. Each push is worked out in plain `f32`
//! from the pair alone and rounded to an integer, and a point's move is the wrapping sum of these integers. Such a sum
//! has no order. Besides, a pair's pushes are equal and opposite to the last bit, and points beyond a pair's reach push
//! by exactly zero, so it does not matter which of them are looked at.
//!
//! # Neighbors
//!
//! [`Cells`] sorts the points by rows about as high as the mean reach, each cut into cells an eighth as wide. The
//! points of a row of cells are neighbors in memory:
//!
//! ```text
//!     ┌─┬─┬─┬─┬─┬─┬─┬─┐
//!     │ │░│░│░│░│░│ │ │      1 to 8: a group, points of one row that move
//!     ├─┼─┼─┼─┼─┼─┼─┼─┤
//!     │ │░│1│2│8│░│ │ │      ░: all cells within the reach of the group;
//!     ├─┼─┼─┼─┼─┼─┼─┼─┤      in each row one run of memory (not to scale)
//!     │ │░│░│░│░│░│ │ │
//!     └─┴─┴─┴─┴─┴─┴─┴─┘
//! ```
//!
//! Up to eight points of a row make a group, one for each lane of a vector. The inner loop takes the points of those
//! runs one after another and adds the push of each to all lanes, without a branch. The reach of a pair depends on the
//! shares of both points. So the reach of a group is first bounded by the least weight of all points, and then by the
//! least weight of the points within that bound, which are often denser.
//!
//! # The move
//!
//! The sum is scaled by the point's freedom and then limited, to [`STEP`] local spacings along each axis in this step
//! and to [`WHOLE`] from the place in the full set. Where points keep a distance D, a move is no longer than half the
//! amount by which the point's nearest neighbor is farther away than D. Two points that approach each other by that
//! much still keep D. Where points of a kind push each other, `kin` has summed those pushes before, and `past` lets a
//! point pass a near neighbor.
//!
//! # Cost
//!
//! A group costs one push of eight lanes for each point within its reach. Points that stay, those at the border of a
//! window, join no group and only push. The loops are compiled once for each instruction set ([`compiled_loop`]), from
//! the same operations in the same order.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    cells::{Cells, MOVES, Places, Sorted},
    past::eased,
    plain::{
        ROUNDER, Root, SPARE, SURELY, above_zero, greater, lesser, rounded, squares, whole_number,
        within,
    },
};
use crate::kernel::{Backend, PlainLoop, compiled_loop};

/// The greatest move in a step along each axis, in local spacings.
pub(super) const STEP: f32 = 0.3;

/// The greatest move in all along each axis, in local spacings.
pub(super) const WHOLE: f32 = 0.4;

/// The pushes of a step: W(u) = (push · max(0, 1 − u/reach²))⁴ + (guard · max(0, 1 − u/near²))², where u is the squared
/// distance of a pair in local spacings of its mean density. Each point of a pair moves by W times the offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kernel {
    pub(super) reach: f32,
    pub(super) push: f32,
    pub(super) near: f32,
    pub(super) guard: f32,
}

/// The number of points whose pushes are summed together.
const LANES: usize = 8;

/// A group ends where it is wider than this, in rows of cells.
const WIDEST: f32 = 2.0;

/// The lengths of a set that all its steps share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// Units of a mean spacing at full density.
    pub(super) unit: f32,
    /// The distance that points keep in any case, in units.
    pub(super) clear: f32,
}

impl<const D: usize> Cells<D> {
    /// Moves the points that move in step number `step`, which counts from 1.
    pub(super) fn step(
        &mut self,
        places: &mut Places<D>,
        (kernel, step): (&Kernel, u8),
        scale: Scale,
        backend: Backend,
    ) {
        if places.len() == 0 {
            return;
        }
        let mut work = Step {
            cells: self,
            places,
            kernel: Prepared::new(kernel, scale.unit),
            step,
            scale,
            sums: None,
        };
        compiled_loop(backend, &mut work);
    }

    /// Sums the pushes on the points that move in a step, and moves none.
    pub(super) fn pushes(
        &mut self,
        places: &mut Places<D>,
        (kernel, step): (&Kernel, u8),
        scale: Scale,
        backend: Backend,
        sums: &mut [Vec<i32>; D],
    ) {
        for list in sums.iter_mut() {
            list.clear();
            list.resize(places.len(), 0);
        }
        if places.len() == 0 {
            return;
        }
        let mut work = Step {
            cells: self,
            places,
            kernel: Prepared::new(kernel, scale.unit),
            step,
            scale,
            sums: Some(sums),
        };
        compiled_loop(backend, &mut work);
    }
}

/// A kernel for squared distances in units, times the weights of both points, which are those of their shares times `weight`:
/// W = max(0, push − a)⁴ + max(0, guard − a · ratio)².
#[derive(Clone, Copy, Debug)]
struct Prepared {
    weight: f32,
    push: f32,
    guard: f32,
    ratio: f32,
    /// The greatest a at which a pair pushes, and a little more for what rounds.
    most: f32,
    /// The greater of both reaches, and that of pushes, in local spacings.
    widest: f32,
    reach: f32,
}

impl Prepared {
    fn new(kernel: &Kernel, unit: f32) -> Self {
        let Kernel {
            reach,
            push,
            near,
            guard,
        } = *kernel;
        let squared = |reach: f32| 0.5 / (((reach * reach) * unit) * unit);
        let weight = squared(reach) * push;
        let ratio = (squared(near) * guard) / weight;
        let far = if guard > 0.0 { guard / ratio } else { 0.0 };
        Self {
            weight,
            push,
            guard,
            ratio,
            most: if push > far { push } else { far } * 1.001,
            widest: if guard > 0.0 && near > reach {
                near
            } else {
                reach
            },
            reach,
        }
    }
}

/// Some points of a row that move, and the sums of the pushes on them.
struct Group<const D: usize> {
    number: usize,
    point: [u32; LANES],
    at: [[f32; LANES]; D],
    weight: [f32; LANES],
    /// The sums of the pushes, with the bits of a rounder for each.
    push: [[i32; LANES]; D],
    /// The squared distance of the nearest point, as bits, less 1.
    nearest: [u32; LANES],
    /// The number of pushes that were summed.
    number_of_pushes: usize,
}

struct Step<'a, const D: usize> {
    cells: &'a mut Cells<D>,
    places: &'a mut Places<D>,
    kernel: Prepared,
    step: u8,
    scale: Scale,
    /// Where the pushes of points go if these do not move.
    sums: Option<&'a mut [Vec<i32>; D]>,
}

impl<const D: usize> PlainLoop for Step<'_, D> {
    #[inline(always)]
    fn run(&mut self) {
        let Prepared { widest, weight, .. } = self.kernel;
        self.cells.sort(self.places, (widest, weight), self.step);
        let (columns, rows) = (self.cells.along[0].cells, self.cells.rows());
        let far = WIDEST * self.cells.side;
        for row in 0..rows {
            let first = self.cells.starts[row * columns] as usize;
            let end = self.cells.starts[(row + 1) * columns] as usize;
            let mut next = first;
            while next < end {
                let mut group = Group::EMPTY;
                let mut last = f32::INFINITY;
                for point in &self.cells.points[next..end] {
                    if point.point & MOVES != 0 {
                        if group.number == LANES || point.at[0] > last {
                            break;
                        }
                        if group.number == 0 {
                            last = point.at[0] + far;
                        }
                        group.add(point);
                    }
                    next += 1;
                }
                if group.number > 0 {
                    group.fill_up();
                    self.sum(&mut group);
                    match &mut self.sums {
                        Some(sums) => group.tell(sums),
                        None => self.go(&group),
                    }
                }
            }
        }
    }
}

impl<const D: usize> Step<'_, D> {
    /// Sums the pushes on a group.
    #[inline(always)]
    fn sum(&self, group: &mut Group<D>) {
        let Cells {
            along,
            starts,
            points,
            ..
        } = &*self.cells;
        let least = |list: &[f32; LANES]| list.iter().fold(f32::INFINITY, |a, &b| lesser(b, a));
        let most = |list: &[f32; LANES]| list.iter().fold(-f32::INFINITY, |a, &b| greater(b, a));
        let ends = group.at.each_ref().map(|list| [least(list), most(list)]);
        let sparse = least(&group.weight);
        let mut around = self.around(ends, sparse, self.cells.least);
        if !self.cells.are_alike {
            // Those within this reach may be denser, so reach less far.
            let least = self.cells.least_in(&around);
            around = self.around(ends, sparse, least);
        }
        for row in self.cells.rows_between(&around) {
            let first = row * along[0].cells;
            let start = starts[first + around[0].start] as usize;
            let end = starts[first + around[0].end] as usize;
            group.add_pushes(&self.kernel, &points[start..end]);
        }
    }

    /// The cells along each axis that may push points between some ends.
    #[inline(always)]
    fn around(&self, ends: [[f32; 2]; D], sparse: f32, least: f32) -> [Range<usize>; D] {
        let reach = (self.kernel.most / (sparse + least)).sqrt_();
        core::array::from_fn(|axis| {
            let [start, end] = ends[axis];
            self.cells.along[axis].cells(start - reach, end + reach)
        })
    }

    /// Moves a group by its pushes.
    #[inline(always)]
    fn go(&mut self, group: &Group<D>) {
        let Scale { unit, clear } = self.scale;
        let reach = self.kernel.reach;
        let mut freedom = [0.0; LANES];
        let mut spacing = [0.0; LANES];
        let mut placed = [[0.0; LANES]; D];
        for k in 0..LANES {
            let i = group.point[k] as usize;
            freedom[k] = self.places.freedom[i];
            spacing[k] = self.places.weight[i];
            for (placed, list) in placed.iter_mut().zip(&self.places.placed) {
                placed[k] = list[i];
            }
        }
        for spacing in &mut spacing {
            *spacing = unit / spacing.sqrt_();
        }
        let mut push = group.pushes();
        let mut nearest = [0.0; LANES];
        for (nearest, bits) in nearest.iter_mut().zip(group.nearest) {
            *nearest = f32::from_bits(bits.wrapping_add(1));
        }
        let has_kin = !self.places.of_kin[0].is_empty();
        if has_kin {
            for k in 0..LANES {
                let i = group.point[k] as usize;
                for (push, list) in push.iter_mut().zip(&self.places.of_kin) {
                    push[k] = push[k].wrapping_add(list[i]);
                }
                freedom[k] = eased(freedom[k], nearest[k], spacing[k]);
            }
        }
        let of = |lists: &[[f32; LANES]; D], k: usize| lists.each_ref().map(|list| list[k]);
        let mut to = [[0.0; LANES]; D];
        for k in 0..LANES {
            let spacing = spacing[k];
            let most = STEP * spacing;
            let mut go = [0.0; D];
            for axis in 0..D {
                go[axis] = within(push[axis][k] as f32 * freedom[k], most);
            }
            // Two points that each go half of the way that is free stay clear of each other.
            let near = lesser(reach * spacing, nearest[k].sqrt_()) * SURELY;
            let free = above_zero((near - clear) * 0.5 - SPARE);
            let length = squares(go).sqrt_();
            let is_longer = (clear > 0.0) & (length > free);
            let part = free / length;
            let part = if is_longer { part } else { 1.0 };
            let whole = WHOLE * spacing;
            for axis in 0..D {
                let placed = placed[axis][k];
                let offset = (group.at[axis][k] + whole_number(go[axis] * part)) - placed;
                to[axis][k] = placed + whole_number(within(offset, whole));
            }
        }
        if has_kin && clear > 0.0 {
            for k in 0..group.number {
                let go = |push: i32| within(push as f32 * freedom[k], STEP * spacing[k]);
                let wish = (push.each_ref().map(|list| go(list[k])), nearest[k]);
                let places = (of(&group.at, k), of(&placed, k));
                if let Some(at) = self.cells.pass(places, wish, WHOLE * spacing[k], clear) {
                    for (to, at) in to.iter_mut().zip(at) {
                        to[k] = at;
                    }
                }
            }
        }
        for (list, to) in self.places.at.iter_mut().zip(to) {
            for (&point, to) in group.point[..group.number].iter().zip(to) {
                list[point as usize] = to;
            }
        }
    }
}

impl<const D: usize> Group<D> {
    const EMPTY: Self = Self {
        number: 0,
        point: [0; LANES],
        at: [[0.0; LANES]; D],
        weight: [0.0; LANES],
        push: [[0; LANES]; D],
        nearest: [f32::INFINITY.to_bits() - 1; LANES],
        number_of_pushes: 0,
    };

    #[inline(always)]
    fn add(&mut self, point: &Sorted<D>) {
        let k = self.number;
        self.point[k] = point.point & !MOVES;
        for (list, at) in self.at.iter_mut().zip(point.at) {
            list[k] = at;
        }
        self.weight[k] = point.weight;
        self.number += 1;
    }

    /// Fills up the lanes with the last point.
    #[inline(always)]
    fn fill_up(&mut self) {
        let last = self.number - 1;
        for k in self.number..LANES {
            self.point[k] = self.point[last];
            for list in &mut self.at {
                list[k] = list[last];
            }
            self.weight[k] = self.weight[last];
        }
    }

    /// The sums of the pushes.
    #[inline(always)]
    fn pushes(&self) -> [[i32; LANES]; D] {
        let rounders = (self.number_of_pushes as i32).wrapping_mul(ROUNDER.to_bits() as i32);
        let mut pushes = self.push;
        for sum in pushes.as_flattened_mut() {
            *sum = sum.wrapping_sub(rounders);
        }
        pushes
    }

    /// Writes the pushes on the points to some lists.
    #[inline(always)]
    fn tell(&self, lists: &mut [Vec<i32>; D]) {
        for (list, pushes) in lists.iter_mut().zip(self.pushes()) {
            for (&point, push) in self.point[..self.number].iter().zip(pushes) {
                list[point as usize] = push;
            }
        }
    }

    /// Adds the pushes of some points.
    #[inline(always)]
    fn add_pushes(&mut self, kernel: &Prepared, points: &[Sorted<D>]) {
        let (at, weight) = (self.at, self.weight);
        let mut push = self.push;
        let mut nearest = self.nearest;
        for other in points {
            for k in 0..LANES {
                let mut offset = [0.0; D];
                for axis in 0..D {
                    offset[axis] = at[axis][k] - other.at[axis];
                }
                let squared = squares(offset);
                let scaled = squared * (weight[k] + other.weight);
                let u = above_zero(kernel.push - scaled);
                let v = above_zero(kernel.guard - scaled * kernel.ratio);
                let u = u * u;
                let force = u * u + v * v;
                for axis in 0..D {
                    push[axis][k] = push[axis][k].wrapping_add(rounded(offset[axis] * force));
                }
                // The point itself, at 0, becomes the greatest number.
                let bits = squared.to_bits().wrapping_sub(1);
                nearest[k] = if bits < nearest[k] { bits } else { nearest[k] };
            }
        }
        (self.push, self.nearest) = (push, nearest);
        self.number_of_pushes += points.len();
    }
}
