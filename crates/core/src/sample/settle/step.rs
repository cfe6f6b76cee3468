//! One step: all pushes of neighbors on the points that move, in any order.
//!
//! Positions are integers, each push is worked out in plain `f32` and rounded to a multiple of a quantum, and a point's
//! move is the wrapping sum of these. So the sum does not depend on the order of neighbors, and a pair's pushes are equal and
//! opposite to the last bit. Points beyond a pair's reach push by zero, so it does not matter which are looked at.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    cells::{Cells, MOVES, Places, Sorted},
    kin::eased,
};
use crate::sample::kernel::{Backend, PlainLoop, compiled_loop};

/// The greatest move in a step along each axis, in local spacings.
pub(super) const STEP: f32 = 0.3;

/// The greatest move in all along each axis, in local spacings.
pub(super) const WHOLE: f32 = 0.4;

/// The pushes of a step: W(u) = push · max(0, 1 − u/reach²)⁴ + guard · max(0, 1 − u/near²)², where u is the squared
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

/// Pushes are multiples of this many fixed-point units, 2⁻¹³ grid units.
pub(super) const QUANTUM: f32 = 128.0;

/// 1.5 · 2²³: a number within ±2²², added to it, is rounded to an integer, in the lower bits.
const ROUNDER: f32 = 12_582_912.0;

/// What steps need to know of a set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// Fixed-point units of a mean spacing at full density.
    pub(super) unit: f32,
    /// The distance that points keep in any case, in fixed-point units.
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
            kernel,
            step,
            scale,
            sums: None,
        };
        compiled_loop(backend, &mut work);
    }

    /// Sums the pushes on the points that move in a step, in quanta, and moves none.
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
            kernel,
            step,
            scale,
            sums: Some(sums),
        };
        compiled_loop(backend, &mut work);
    }
}

/// Some points of a row that move, and the sums of the pushes on them.
struct Group {
    number: usize,
    point: [u32; LANES],
    x: [i32; LANES],
    y: [i32; LANES],
    share: [f32; LANES],
    /// The sums of the pushes in quanta, with the bits of a rounder for each.
    push_x: [i32; LANES],
    push_y: [i32; LANES],
    /// The squared distance of the nearest point, in fixed-point units.
    nearest: [f32; LANES],
    /// The number of pushes that were summed.
    number_of_pushes: usize,
}

struct Step<'a> {
    cells: &'a mut Cells,
    places: &'a mut Places,
    kernel: &'a Kernel,
    step: u8,
    scale: Scale,
    /// Where the pushes of points go if these do not move.
    sums: Option<&'a mut [Vec<i32>; 2]>,
}

impl PlainLoop for Step<'_> {
    #[inline(always)]
    fn run(&mut self) {
        let widest = f64::from(self.kernel.reach.max(self.kernel.near));
        self.cells.sort(self.places, widest, self.step);
        let [columns, rows] = self.cells.along.map(|along| along.cells);
        let far = (WIDEST * self.cells.side as f32) as i32;
        for row in 0..rows {
            let first = self.cells.starts[row * columns] as usize;
            let end = self.cells.starts[(row + 1) * columns] as usize;
            let mut next = first;
            while next < end {
                let mut group = Group::EMPTY;
                let mut last = i32::MAX;
                while next < end && group.number < LANES {
                    let point = self.cells.points[next];
                    if point.point & MOVES != 0 {
                        if group.number == 0 {
                            last = point.at[0].saturating_add(far);
                        } else if point.at[0] > last {
                            break;
                        }
                        group.add(&point);
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
        let least = |list: &[i32; LANES]| list.iter().fold(i32::MAX, |a, &b| a.min(b));
        let most = |list: &[i32; LANES]| list.iter().fold(i32::MIN, |a, &b| a.max(b));
        let ends = [&group.x, &group.y].map(|list| (least(list), most(list)));
        let sparse = group
            .share
            .iter()
            .fold(1.0f32, |a, &b| if b < a { b } else { a });
        let mut around = self.around(ends, sparse, self.cells.least);
        if !self.cells.are_alike {
            // Those within this reach may be denser, so reach less far.
            let least = self.cells.least_in(&around);
            around = self.around(ends, sparse, least);
        }
        let [columns, rows] = around;
        let kernel = Prepared::new(self.kernel, self.scale.unit);
        for row in rows {
            let [start, end] =
                [columns.start, columns.end].map(|c| starts[row * x.cells + c] as usize);
            group.add_pushes(&kernel, &points[start..end]);
        }
    }

    /// The columns and rows of cells that may push points between some ends.
    #[inline(always)]
    fn around(&self, ends: [(i32, i32); 2], sparse: f32, least: f32) -> [Range<usize>; 2] {
        let widest = self.kernel.reach.max(self.kernel.near);
        // A little more than √2, for what rounds.
        let reach = (widest * 1.416 * self.scale.unit / (sparse + least).sqrt_()) as i64 + 1;
        [0, 1].map(|axis| {
            let (from, to) = ends[axis];
            self.cells.along[axis].cells(i64::from(from) - reach, i64::from(to) + reach)
        })
    }

    /// Moves a group by its pushes.
    #[inline(always)]
    fn go(&mut self, group: &Group) {
        let unit = self.scale.unit;
        let clear = self.scale.clear;
        let mut freedom = [0.0; LANES];
        let mut placed = [[0; LANES]; 2];
        for k in 0..LANES {
            let i = group.point[k] as usize;
            freedom[k] = self.places.freedom[i];
            for (placed, list) in placed.iter_mut().zip(&self.places.placed) {
                placed[k] = list[i];
            }
        }
        let [mut push_x, mut push_y] = group.pushes();
        if let [xs, ys] = &self.places.of_kin
            && !xs.is_empty()
        {
            for k in 0..LANES {
                let i = group.point[k] as usize;
                push_x[k] = push_x[k].wrapping_add(xs[i]);
                push_y[k] = push_y[k].wrapping_add(ys[i]);
                let spacing = unit / group.share[k].sqrt_();
                freedom[k] = eased(freedom[k], group.nearest[k], spacing);
            }
        }
        let mut to = [[0; LANES]; 2];
        for k in 0..LANES {
            let spacing = unit / group.share[k].sqrt_();
            let most = STEP * spacing;
            let go = |push: i32| within(push as f32 * QUANTUM * freedom[k], most);
            let (mut x, mut y) = (go(push_x[k]), go(push_y[k]));
            // Two points that each go half of the way that is free stay clear of each other.
            let far = self.kernel.reach * spacing;
            let free = (lesser(far, group.nearest[k].sqrt_()) * SURELY - clear) * 0.5;
            let free = above_zero(free);
            let length = (x * x + y * y).sqrt_();
            let is_longer = (clear > 0.0) & (length > free);
            let part = free / length;
            x = if is_longer { x * part } else { x };
            y = if is_longer { y * part } else { y };
            let whole = WHOLE * spacing;
            let settle = |at: i32, go: f32, placed: i32| {
                let moved = at.wrapping_add(go as i32);
                let offset = moved.wrapping_sub(placed) as f32;
                placed.wrapping_add(within(offset, whole) as i32)
            };
            to[0][k] = settle(group.x[k], x, placed[0][k]);
            to[1][k] = settle(group.y[k], y, placed[1][k]);
        }
        if !self.places.of_kin[0].is_empty() && clear > 0.0 {
            for k in 0..group.number {
                let spacing = unit / group.share[k].sqrt_();
                let go = |push: i32| within(push as f32 * QUANTUM * freedom[k], STEP * spacing);
                let wish = ([go(push_x[k]), go(push_y[k])], group.nearest[k]);
                let at = [group.x[k], group.y[k]];
                let placed = [placed[0][k], placed[1][k]];
                if let Some(at) = self.cells.pass((at, placed), wish, WHOLE * spacing, clear) {
                    [to[0][k], to[1][k]] = at;
                }
            }
        }
        for k in 0..group.number {
            let i = group.point[k] as usize;
            for (list, to) in self.places.at.iter_mut().zip(&to) {
                list[i] = to[k];
            }
        }
    }
}

impl Group {
    const EMPTY: Self = Self {
        number: 0,
        point: [0; LANES],
        x: [0; LANES],
        y: [0; LANES],
        share: [0.0; LANES],
        push_x: [0; LANES],
        push_y: [0; LANES],
        nearest: [f32::INFINITY; LANES],
        number_of_pushes: 0,
    };

    #[inline(always)]
    fn add(&mut self, point: &Sorted) {
        let k = self.number;
        self.point[k] = point.point & !MOVES;
        [self.x[k], self.y[k]] = point.at;
        self.share[k] = point.share;
        self.number += 1;
    }

    /// Fills up the lanes with the last point.
    #[inline(always)]
    fn fill_up(&mut self) {
        let last = self.number - 1;
        for k in self.number..LANES {
            self.point[k] = self.point[last];
            (self.x[k], self.y[k]) = (self.x[last], self.y[last]);
            self.share[k] = self.share[last];
        }
    }

    /// The sums of the pushes in quanta.
    #[inline(always)]
    fn pushes(&self) -> [[i32; LANES]; 2] {
        let rounders = (self.number_of_pushes as i32).wrapping_mul(ROUNDER.to_bits() as i32);
        [self.push_x, self.push_y].map(|sums| sums.map(|sum| sum.wrapping_sub(rounders)))
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
        let (x, y, share) = (self.x, self.y, self.share);
        let (mut push_x, mut push_y) = (self.push_x, self.push_y);
        let mut nearest = self.nearest;
        for other in points {
            for k in 0..LANES {
                let dx = x[k].wrapping_sub(other.at[0]) as f32;
                let dy = y[k].wrapping_sub(other.at[1]) as f32;
                let squared = dx * dx + dy * dy;
                let scaled = squared * (share[k] + other.share);
                let u = above_zero(1.0 - scaled * kernel.by_reach);
                let v = above_zero(1.0 - scaled * kernel.by_near);
                let u = u * u;
                let force = kernel.push * (u * u) + kernel.guard * (v * v);
                push_x[k] = push_x[k].wrapping_add(rounded(dx * force));
                push_y[k] = push_y[k].wrapping_add(rounded(dy * force));
                // Not the point itself.
                let other = if squared > 0.0 {
                    squared
                } else {
                    f32::INFINITY
                };
                nearest[k] = lesser(other, nearest[k]);
            }
        }
        (self.push_x, self.push_y, self.nearest) = (push_x, push_y, nearest);
        self.number_of_pushes += points.len();
    }
}

/// A kernel whose distances are in fixed-point units, and pushes in quanta.
struct Prepared {
    by_reach: f32,
    by_near: f32,
    push: f32,
    guard: f32,
}

impl Prepared {
    #[inline(always)]
    fn new(kernel: &Kernel, unit: f32) -> Self {
        let squared = |reach: f32| 0.5 / (reach * reach * unit * unit);
        Self {
            by_reach: squared(kernel.reach),
            by_near: squared(kernel.near),
            // Exact, for the quantum is a power of two.
            push: kernel.push * (1.0 / QUANTUM),
            guard: kernel.guard * (1.0 / QUANTUM),
        }
    }
}

/// Less than 1 by more than what rounds.
pub(super) const SURELY: f32 = 1.0 - 1.0 / 262_144.0;

/// A number within ±`most`.
#[inline(always)]
pub(super) fn within(v: f32, most: f32) -> f32 {
    if v > most {
        most
    } else if v < -most {
        -most
    } else {
        v
    }
}

/// A push in quanta, to the nearest integer, plus the bits of the rounder.
#[inline(always)]
fn rounded(push: f32) -> i32 {
    (push + ROUNDER).to_bits() as i32
}

#[inline(always)]
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(super) fn above_zero(v: f32) -> f32 {
    if v > 0.0 { v } else { 0.0 }
}

/// The square root, which rounds alike everywhere.
pub(super) trait Root {
    fn sqrt_(self) -> Self;
}

impl Root for f32 {
    #[inline(always)]
    fn sqrt_(self) -> Self {
        #[cfg(feature = "std")]
        return self.sqrt();
        #[cfg(not(feature = "std"))]
        libm::sqrtf(self)
    }
}
