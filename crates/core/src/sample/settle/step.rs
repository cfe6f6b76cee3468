//! One step: all pushes of neighbors on the points that move, in any order.
//!
//! Positions are integers, each push is worked out in plain `f32` and rounded to a multiple of a quantum, and a point's
//! move is the wrapping sum of these. So the sum does not depend on the order of neighbors, and a pair's pushes are equal and
//! opposite to the last bit. Points beyond a pair's reach push by zero, so it does not matter which are looked at.

use alloc::vec::Vec;

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

/// Lists are read in vectors of this many.
const PAD: usize = 16;

/// The width of a cell for each unit of a pair's reach, so that three cells across are looked at.
const CELL: f64 = 1.005;

/// Pushes are multiples of this many fixed-point units, 2⁻¹³ grid units.
const QUANTUM: f32 = 128.0;

/// 1.5 · 2²³: a number within ±2²², added to it, is rounded to an integer, in the lower bits.
const ROUNDER: f32 = 12_582_912.0;

/// The number of cells along an axis is at most this.
const MOST_CELLS: i64 = 1024;

/// The points of a window, in no order. All lists have the same length.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    /// Where they are and where they were placed, in fixed-point units from a corner.
    pub(super) at: [Vec<i32>; 2],
    pub(super) placed: [Vec<i32>; 2],
    /// The shares, not below [`LEAST_SHARE`](super::LEAST_SHARE).
    pub(super) share: Vec<f32>,
    /// The part of each move that is made.
    pub(super) freedom: Vec<f32>,
    /// The steps in which a point moves: those up to this.
    pub(super) until: Vec<u8>,
}

impl Places {
    pub(super) fn clear(&mut self) {
        for list in self.at.iter_mut().chain(&mut self.placed) {
            list.clear();
        }
        self.share.clear();
        self.freedom.clear();
        self.until.clear();
    }

    pub(super) const fn len(&self) -> usize {
        self.share.len()
    }
}

/// What steps need to know of a set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// Fixed-point units of a mean spacing at full density.
    pub(super) unit: f32,
    /// The distance that points keep in any case, in fixed-point units.
    pub(super) clear: f32,
}

/// The memory of steps: the points sorted by square cells.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    corner: [i32; 2],
    side: i32,
    /// The number of cells along x and y.
    across: [usize; 2],
    /// By cell, row after row: the place of its first point in the lists; one more for the end.
    starts: Vec<u32>,
    /// By cell: the last step in which any of its points moves.
    until: Vec<u8>,
    cell: Vec<u32>,
    points: Vec<u32>,
    x: Vec<i32>,
    y: Vec<i32>,
    share: Vec<f32>,
    /// The least share of all points.
    least: f32,
    /// The points near a cell.
    near: Near,
    moves: Vec<(u32, [i32; 2])>,
}

#[derive(Clone, Debug, Default)]
struct Near {
    x: Vec<i32>,
    y: Vec<i32>,
    share: Vec<f32>,
}

impl Near {
    fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
        self.share.clear();
    }

    /// Fills up the last vector with points that push nothing.
    fn pad(&mut self) {
        let whole = self.x.len().next_multiple_of(PAD);
        self.x.resize(whole, 0);
        self.y.resize(whole, 0);
        self.share.resize(whole, f32::INFINITY);
    }
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
        self.sort(places, f64::from(kernel.reach.max(kernel.near)));
        let mut work = Step {
            cells: self,
            places,
            kernel,
            step,
            scale,
        };
        compiled_loop(backend, &mut work);
        for (i, to) in self.moves.drain(..) {
            let i = i as usize;
            for (list, to) in places.at.iter_mut().zip(to) {
                list[i] = to;
            }
        }
    }

    /// Sorts the points by cells. Which cell a point is in never matters to where it goes.
    fn sort(&mut self, places: &Places, reach: f64) {
        let [xs, ys] = &places.at;
        let ends = [xs, ys].map(|list| {
            let ends = (i32::MAX, i32::MIN);
            list.iter().fold(ends, |(a, b), &v| (a.min(v), b.max(v)))
        });
        let number = places.len();
        let extents = ends.map(|(a, b)| i64::from(b) - i64::from(a) + 1);
        let area = extents[0] as f64 * extents[1] as f64;
        let side = (CELL * reach * libm::sqrt(area / number as f64)) as i64;
        let side = extents
            .iter()
            .fold(side, |side, e| side.max(e / MOST_CELLS));
        let side = side.clamp(1 << 16, i64::from(i32::MAX));
        self.side = side as i32;
        self.corner = ends.map(|(a, _)| a);
        self.across = extents.map(|extent| ((extent - 1) / side) as usize + 1);
        let cells = self.across[0] * self.across[1];
        self.starts.clear();
        self.starts.resize(cells + 1, 0);
        self.until.clear();
        self.until.resize(cells, 0);
        self.cell.clear();
        let per_side = 1.0 / self.side as f32;
        self.least = f32::INFINITY;
        for i in 0..number {
            let cell = |v: i32, axis: usize| {
                let offset = v.wrapping_sub(self.corner[axis]) as u32;
                ((offset as f32 * per_side) as usize).min(self.across[axis] - 1)
            };
            let cell = cell(ys[i], 1) * self.across[0] + cell(xs[i], 0);
            self.cell.push(cell as u32);
            self.starts[cell] += 1;
            self.until[cell] = self.until[cell].max(places.until[i]);
            self.least = self.least.min(places.share[i]);
        }
        let mut before = 0;
        for start in &mut self.starts {
            before += *start;
            *start = before;
        }
        for list in [&mut self.x, &mut self.y] {
            list.resize(number, 0);
        }
        self.points.resize(number, 0);
        self.share.resize(number, 0.0);
        for (i, &cell) in self.cell.iter().enumerate().rev() {
            let start = &mut self.starts[cell as usize];
            *start -= 1;
            let to = *start as usize;
            self.points[to] = i as u32;
            (self.x[to], self.y[to], self.share[to]) = (xs[i], ys[i], places.share[i]);
        }
    }
}

struct Step<'a> {
    cells: &'a mut Cells,
    places: &'a Places,
    kernel: &'a Kernel,
    step: u8,
    scale: Scale,
}

impl PlainLoop for Step<'_> {
    #[inline(always)]
    fn run(&mut self) {
        let [columns, rows] = self.cells.across;
        for row in 0..rows {
            for column in 0..columns {
                if self.cells.until[row * columns + column] >= self.step {
                    self.cell(column, row);
                }
            }
        }
    }
}

impl Step<'_> {
    /// Moves the points of a cell.
    #[inline(always)]
    fn cell(&mut self, column: usize, row: usize) {
        let Cells {
            side,
            across: [columns, rows],
            starts,
            points,
            x,
            y,
            share,
            least,
            near,
            moves,
            ..
        } = &mut *self.cells;
        let (columns, rows) = (*columns, *rows);
        let cell = row * columns + column;
        let own = starts[cell] as usize..starts[cell + 1] as usize;
        let sparse = share[own.clone()].iter().fold(1.0f32, |a, &b| a.min(b));
        let unit = self.scale.unit;
        let widest = self.kernel.reach.max(self.kernel.near);
        // A little more, for cells that are rounded.
        let reach = widest * 1.415 * unit / (sparse + *least).sqrt_();
        let wide = ((reach / *side as f32) * 1.001) as usize + 1;
        let from = column.saturating_sub(wide);
        let to = (column + wide + 1).min(columns);
        near.clear();
        for row in row.saturating_sub(wide)..(row + wide + 1).min(rows) {
            let start = starts[row * columns + from] as usize;
            let end = starts[row * columns + to] as usize;
            near.x.extend_from_slice(&x[start..end]);
            near.y.extend_from_slice(&y[start..end]);
            near.share.extend_from_slice(&share[start..end]);
        }
        near.pad();
        for k in own {
            let i = points[k] as usize;
            let (places, freedom) = (self.places, self.places.freedom[i]);
            if places.until[i] < self.step || freedom == 0.0 {
                continue;
            }
            let (at, share) = ([x[k], y[k]], share[k]);
            let (push, nearest) = pushes(near, self.kernel, unit, (at, share));
            let spacing = unit / share.sqrt_();
            let most = STEP * spacing;
            let mut go = push.map(|v| within(v as f32 * QUANTUM * freedom, most));
            if self.scale.clear > 0.0 {
                // Two points that each go half of the way that is free stay clear of each other.
                let far = self.kernel.reach * spacing;
                let free = (far.min(nearest.sqrt_()) * SURELY - self.scale.clear) * 0.5;
                let free = if free > 0.0 { free } else { 0.0 };
                let length = (go[0] * go[0] + go[1] * go[1]).sqrt_();
                if length > free {
                    let part = free / length;
                    go = go.map(|v| v * part);
                }
            }
            let whole = WHOLE * spacing;
            let to = [0, 1].map(|axis| {
                let placed = places.placed[axis][i];
                let moved = at[axis].wrapping_add(go[axis] as i32);
                placed.wrapping_add(within(moved.wrapping_sub(placed) as f32, whole) as i32)
            });
            moves.push((i as u32, to));
        }
    }
}

/// Less than 1 by more than what rounds.
const SURELY: f32 = 1.0 - 1.0 / 262_144.0;

/// A number within ±`most`.
#[inline(always)]
fn within(v: f32, most: f32) -> f32 {
    if v > most {
        most
    } else if v < -most {
        -most
    } else {
        v
    }
}

/// The sum of the pushes on a point, and the squared distance of the nearest one, in fixed-point units.
#[inline(always)]
fn pushes(
    near: &Near,
    kernel: &Kernel,
    unit: f32,
    (at, share): ([i32; 2], f32),
) -> ([i32; 2], f32) {
    let squared = |reach: f32| 0.5 / (reach * reach * unit * unit);
    let [by_reach, by_near] = [squared(kernel.reach), squared(kernel.near)];
    let (mut sum_x, mut sum_y) = ([0i32; PAD], [0i32; PAD]);
    let mut nearest = [f32::INFINITY; PAD];
    let lists = near.x.as_chunks::<PAD>().0.iter();
    let lists = lists.zip(near.y.as_chunks::<PAD>().0);
    let lists = lists.zip(near.share.as_chunks::<PAD>().0);
    for ((xs, ys), shares) in lists {
        for k in 0..PAD {
            let dx = at[0].wrapping_sub(xs[k]) as f32;
            let dy = at[1].wrapping_sub(ys[k]) as f32;
            let squared = dx * dx + dy * dy;
            let scaled = squared * (share + shares[k]);
            let u = above_zero(1.0 - scaled * by_reach);
            // Neither the point itself nor one that pads.
            let is_other = (u > 0.0) & (scaled > 0.0);
            let v = above_zero(1.0 - scaled * by_near);
            let u = u * u;
            let force = kernel.push * (u * u) + kernel.guard * (v * v);
            sum_x[k] = sum_x[k].wrapping_add(rounded(dx * force));
            sum_y[k] = sum_y[k].wrapping_add(rounded(dy * force));
            let other = if is_other { squared } else { f32::INFINITY };
            nearest[k] = if other < nearest[k] {
                other
            } else {
                nearest[k]
            };
        }
    }
    // Each has the bits of the rounder.
    let rounders = (near.x.len() as i32).wrapping_mul(ROUNDER.to_bits() as i32);
    let sum = |all: [i32; PAD]| {
        let sum = all.iter().fold(0i32, |a, &b| a.wrapping_add(b));
        sum.wrapping_sub(rounders)
    };
    let least = nearest
        .iter()
        .fold(f32::INFINITY, |a, &b| if b < a { b } else { a });
    ([sum(sum_x), sum(sum_y)], least)
}

/// A push in quanta, to the nearest integer, plus the bits of the rounder.
#[inline(always)]
fn rounded(push: f32) -> i32 {
    (push * (1.0 / QUANTUM) + ROUNDER).to_bits() as i32
}

#[inline(always)]
fn above_zero(v: f32) -> f32 {
    if v > 0.0 { v } else { 0.0 }
}

/// The square root, which rounds alike everywhere.
trait Root {
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
