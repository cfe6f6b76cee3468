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
        ROUNDER, Root, SPARE, SURELY, above_zero, greater, lesser, rounded, whole_number, within,
    },
};
use crate::sample::kernel::{Backend, PlainLoop, compiled_loop};

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

impl Cells {
    /// Moves the points that move in step number `step`, which counts from 1.
    pub(super) fn step(
        &mut self,
        places: &mut Places,
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
        places: &mut Places,
        (kernel, step): (&Kernel, u8),
        scale: Scale,
        backend: Backend,
        sums: &mut [Vec<i32>; 2],
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

/// A kernel for squared distances in units, times the weights of both points, which are their shares times `weight`:
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
struct Group {
    number: usize,
    point: [u32; LANES],
    x: [f32; LANES],
    y: [f32; LANES],
    weight: [f32; LANES],
    /// The sums of the pushes, with the bits of a rounder for each.
    push_x: [i32; LANES],
    push_y: [i32; LANES],
    /// The squared distance of the nearest point, as bits, less 1.
    nearest: [u32; LANES],
    /// The number of pushes that were summed.
    number_of_pushes: usize,
}

struct Step<'a> {
    cells: &'a mut Cells,
    places: &'a mut Places,
    kernel: Prepared,
    step: u8,
    scale: Scale,
    /// Where the pushes of points go if these do not move.
    sums: Option<&'a mut [Vec<i32>; 2]>,
}

impl PlainLoop for Step<'_> {
    #[inline(always)]
    fn run(&mut self) {
        let Prepared { widest, weight, .. } = self.kernel;
        self.cells.sort(self.places, (widest, weight), self.step);
        let [columns, rows] = self.cells.along.map(|along| along.cells);
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

impl Step<'_> {
    /// Sums the pushes on a group.
    #[inline(always)]
    fn sum(&self, group: &mut Group) {
        let Cells {
            along: [x, _],
            starts,
            points,
            ..
        } = &*self.cells;
        let least = |list: &[f32; LANES]| list.iter().fold(f32::INFINITY, |a, &b| lesser(b, a));
        let most = |list: &[f32; LANES]| list.iter().fold(-f32::INFINITY, |a, &b| greater(b, a));
        let ends = [
            [least(&group.x), most(&group.x)],
            [least(&group.y), most(&group.y)],
        ];
        let sparse = least(&group.weight);
        let mut around = self.around(ends, sparse, self.cells.least);
        if !self.cells.are_alike {
            // Those within this reach may be denser, so reach less far.
            let least = self.cells.least_in(&around);
            around = self.around(ends, sparse, least);
        }
        let [columns, rows] = around;
        for row in rows {
            let first = row * x.cells;
            let start = starts[first + columns.start] as usize;
            let end = starts[first + columns.end] as usize;
            group.add_pushes(&self.kernel, &points[start..end]);
        }
    }

    /// The columns and rows of cells that may push points between some ends.
    #[inline(always)]
    fn around(&self, ends: [[f32; 2]; 2], sparse: f32, least: f32) -> [Range<usize>; 2] {
        let reach = (self.kernel.most / (sparse + least)).sqrt_();
        let [[left, right], [bottom, top]] = ends;
        let [x, y] = self.cells.along;
        [
            x.cells(left - reach, right + reach),
            y.cells(bottom - reach, top + reach),
        ]
    }

    /// Moves a group by its pushes.
    #[inline(always)]
    fn go(&mut self, group: &Group) {
        let Scale { unit, clear } = self.scale;
        let reach = self.kernel.reach;
        let mut freedom = [0.0; LANES];
        let mut share = [0.0; LANES];
        let mut placed = [[0.0; LANES]; 2];
        for k in 0..LANES {
            let i = group.point[k] as usize;
            freedom[k] = self.places.freedom[i];
            share[k] = self.places.share[i];
            placed[0][k] = self.places.placed[0][i];
            placed[1][k] = self.places.placed[1][i];
        }
        let [mut push_x, mut push_y] = group.pushes();
        let mut nearest = [0.0; LANES];
        for (nearest, bits) in nearest.iter_mut().zip(group.nearest) {
            *nearest = f32::from_bits(bits.wrapping_add(1));
        }
        if let [xs, ys] = &self.places.of_kin
            && !xs.is_empty()
        {
            for k in 0..LANES {
                let i = group.point[k] as usize;
                push_x[k] = push_x[k].wrapping_add(xs[i]);
                push_y[k] = push_y[k].wrapping_add(ys[i]);
                let spacing = unit / share[k].sqrt_();
                freedom[k] = eased(freedom[k], nearest[k], spacing);
            }
        }
        let mut to = [[0.0; LANES]; 2];
        for k in 0..LANES {
            let spacing = unit / share[k].sqrt_();
            let most = STEP * spacing;
            let go = |push: i32| within(push as f32 * freedom[k], most);
            let (mut x, mut y) = (go(push_x[k]), go(push_y[k]));
            // Two points that each go half of the way that is free stay clear of each other.
            let near = lesser(reach * spacing, nearest[k].sqrt_()) * SURELY;
            let free = above_zero((near - clear) * 0.5 - SPARE);
            let length = (x * x + y * y).sqrt_();
            let is_longer = (clear > 0.0) & (length > free);
            let part = free / length;
            let part = if is_longer { part } else { 1.0 };
            (x, y) = (x * part, y * part);
            let whole = WHOLE * spacing;
            let settle = |at: f32, go: f32, placed: f32| {
                let offset = (at + whole_number(go)) - placed;
                placed + whole_number(within(offset, whole))
            };
            to[0][k] = settle(group.x[k], x, placed[0][k]);
            to[1][k] = settle(group.y[k], y, placed[1][k]);
        }
        if !self.places.of_kin[0].is_empty() && clear > 0.0 {
            for k in 0..group.number {
                let spacing = unit / share[k].sqrt_();
                let go = |push: i32| within(push as f32 * freedom[k], STEP * spacing);
                let wish = ([go(push_x[k]), go(push_y[k])], nearest[k]);
                let at = [group.x[k], group.y[k]];
                let placed = [placed[0][k], placed[1][k]];
                if let Some(at) = self.cells.pass((at, placed), wish, WHOLE * spacing, clear) {
                    [to[0][k], to[1][k]] = at;
                }
            }
        }
        let points = group.point[..group.number].iter();
        for (&point, (&x, &y)) in points.zip(to[0].iter().zip(&to[1])) {
            self.places.at[0][point as usize] = x;
            self.places.at[1][point as usize] = y;
        }
    }
}

impl Group {
    const EMPTY: Self = Self {
        number: 0,
        point: [0; LANES],
        x: [0.0; LANES],
        y: [0.0; LANES],
        weight: [0.0; LANES],
        push_x: [0; LANES],
        push_y: [0; LANES],
        nearest: [f32::INFINITY.to_bits() - 1; LANES],
        number_of_pushes: 0,
    };

    #[inline(always)]
    fn add(&mut self, point: &Sorted) {
        let k = self.number;
        self.point[k] = point.point & !MOVES;
        [self.x[k], self.y[k]] = point.at;
        self.weight[k] = point.weight;
        self.number += 1;
    }

    /// Fills up the lanes with the last point.
    #[inline(always)]
    fn fill_up(&mut self) {
        let last = self.number - 1;
        for k in self.number..LANES {
            self.point[k] = self.point[last];
            (self.x[k], self.y[k]) = (self.x[last], self.y[last]);
            self.weight[k] = self.weight[last];
        }
    }

    /// The sums of the pushes.
    #[inline(always)]
    fn pushes(&self) -> [[i32; LANES]; 2] {
        let rounders = (self.number_of_pushes as i32).wrapping_mul(ROUNDER.to_bits() as i32);
        let mut pushes = [self.push_x, self.push_y];
        for sum in pushes.as_flattened_mut() {
            *sum = sum.wrapping_sub(rounders);
        }
        pushes
    }

    /// Writes the pushes on the points to some lists.
    #[inline(always)]
    fn tell(&self, lists: &mut [Vec<i32>; 2]) {
        for (list, pushes) in lists.iter_mut().zip(self.pushes()) {
            for (&point, push) in self.point[..self.number].iter().zip(pushes) {
                list[point as usize] = push;
            }
        }
    }

    /// Adds the pushes of some points.
    #[inline(always)]
    fn add_pushes(&mut self, kernel: &Prepared, points: &[Sorted]) {
        let (x, y, weight) = (self.x, self.y, self.weight);
        let (mut push_x, mut push_y) = (self.push_x, self.push_y);
        let mut nearest = self.nearest;
        for other in points {
            for k in 0..LANES {
                let dx = x[k] - other.at[0];
                let dy = y[k] - other.at[1];
                let squared = dx * dx + dy * dy;
                let scaled = squared * (weight[k] + other.weight);
                let u = above_zero(kernel.push - scaled);
                let v = above_zero(kernel.guard - scaled * kernel.ratio);
                let u = u * u;
                let force = u * u + v * v;
                push_x[k] = push_x[k].wrapping_add(rounded(dx * force));
                push_y[k] = push_y[k].wrapping_add(rounded(dy * force));
                // The point itself, at 0, becomes the greatest number.
                let bits = squared.to_bits().wrapping_sub(1);
                nearest[k] = if bits < nearest[k] { bits } else { nearest[k] };
            }
        }
        (self.push_x, self.push_y, self.nearest) = (push_x, push_y, nearest);
        self.number_of_pushes += points.len();
    }
}
