//! The limit of the near step, that of sets with all points: it keeps points clear of each other.
//!
//! # The problem
//!
//! The table promises a distance D for any two points, and the nearest pairs of a full set lie hardly farther apart.
//! The limit of the other steps, half of what separates a point from D in any direction, would leave no move.
//!
//! # The idea
//!
//! Each point is limited toward each neighbor alone: of a distance r between two points it approaches the other one
//! by at most (r − D)/2. Moves away from a neighbor are free:
//!
//! ```text
//!     i ├── at most (r − D)/2 ──┤─────── D ───────├── at most (r − D)/2 ──┤ j
//! ```
//!
//! Along the line between their first places the two are then D apart, or more, so their distance is at least D. A
//! neighbor beyond the reach of the step is not looked at: no move is longer than half of what separates the reach from
//! D, so that pair keeps D as well.
//!
//! # Invariants
//!
//! - Limits follow from the places before the step, not from how others move, so points are limited in any order.
//! - A move is shortened by one factor for all neighbors, and truncated to integers. Truncating may turn it a little,
//!   so it is compared with all neighbors again; a move that now goes too far is dropped.
//! - Lengths are computed in `f64` and counted short by [`SURELY`], and D long by [`SPARE`], by more than they round.

use alloc::vec::Vec;
use core::array::from_fn;

use super::{
    cells::Places,
    freedom::root,
    plain::{greater, lesser},
};

/// The distance that two points keep beyond D, in the units of a window: more than rounding takes from it.
const SPARE: f64 = 4.0;

/// A factor for lengths: less than 1 by more than their rounding errors.
const SURELY: f64 = 1.0 - 1.0 / 262_144.0;

/// The limit of a near step, with memory to find neighbors: the points by cells about as large as its reach.
#[derive(Clone, Debug)]
pub(super) struct Near<const D: usize> {
    /// The distances in the units of a window: D, and the reach.
    clear: f64,
    reach: f64,
    corner: [f32; D],
    /// The cells along each axis.
    across: [usize; D],
    /// By cell: the place of its first point; one more for the end.
    starts: Vec<u32>,
    points: Vec<u32>,
}

impl<const D: usize> Near<D> {
    pub(super) fn new(clear: f64, reach: f64) -> Self {
        Self {
            clear,
            reach,
            corner: [0.0; D],
            across: [0; D],
            starts: Vec::new(),
            points: Vec::new(),
        }
    }

    /// Shortens the moves of the points of a window from the places where they were placed.
    pub(super) fn limit(&mut self, places: &mut Places<D>) {
        if places.len() == 0 {
            return;
        }
        self.sort(&places.placed);
        let Places { at, placed, .. } = places;
        for i in 0..placed[0].len() {
            let own = placed.each_ref().map(|list| list[i]);
            let go: [f64; D] = from_fn(|k| f64::from(at[k][i]) - f64::from(own[k]));
            if go != [0.0; D] {
                let go = self.limited(placed, own, go);
                for (k, list) in at.iter_mut().enumerate() {
                    list[i] = own[k] + go[k];
                }
            }
        }
    }

    /// The move of a point, shortened.
    fn limited(&self, placed: &[Vec<f32>; D], own: [f32; D], go: [f64; D]) -> [f32; D] {
        let free = |far: f64| (far * SURELY - self.clear - SPARE).max(0.0) * 0.5;
        let length = root(product(go, go));
        let mut part = (free(self.reach) / length).min(1.0);
        self.visit(placed, own, |offset, far| {
            let approach = product(go, offset) / far;
            let free = free(far);
            if free <= 0.0 {
                part = 0.0;
            } else if approach > 0.0 {
                part = part.min(free / approach);
            }
        });
        let go = go.map(|v| libm::trunc(v * part) as f32);
        // Rounding may have turned the move a little.
        let mut is_clear = true;
        self.visit(placed, own, |offset, far| {
            let approach = product(go.map(f64::from), offset);
            is_clear &= approach <= free(far) * far;
        });
        if is_clear { go } else { [0.0; D] }
    }

    /// Calls `visit` with the offsets and distances of all points within reach of one.
    fn visit(&self, placed: &[Vec<f32>; D], own: [f32; D], mut visit: impl FnMut([f64; D], f64)) {
        let cell = self.cell(own);
        let [first, end]: [[usize; D]; 2] = [
            cell.map(|v| v.saturating_sub(1)),
            from_fn(|axis| (cell[axis] + 2).min(self.across[axis])),
        ];
        let mut row = first;
        while row[D - 1] < end[D - 1] {
            let [from, to] = [first[0], end[0]].map(|column| {
                row[0] = column;
                self.starts[self.number(row)] as usize
            });
            for &other in &self.points[from..to] {
                let offset = from_fn(|k| f64::from(placed[k][other as usize]) - f64::from(own[k]));
                let far = root(product(offset, offset));
                if far > 0.0 && far < self.reach {
                    visit(offset, far);
                }
            }
            row[1] += 1;
            for axis in 1..D - 1 {
                if row[axis] == end[axis] {
                    row[axis] = first[axis];
                    row[axis + 1] += 1;
                }
            }
        }
    }

    /// The cell of a place along each axis.
    fn cell(&self, at: [f32; D]) -> [usize; D] {
        // Somewhat larger than the reach, for what rounds.
        let side = self.reach + 1.0;
        from_fn(|k| ((f64::from(at[k]) - f64::from(self.corner[k])) / side) as usize)
    }

    /// The number of a cell.
    fn number(&self, cell: [usize; D]) -> usize {
        (0..D)
            .rev()
            .fold(0, |number, axis| number * self.across[axis] + cell[axis])
    }

    /// Sorts places by cells.
    fn sort(&mut self, placed: &[Vec<f32>; D]) {
        let least = |list: &[f32]| list.iter().fold(f32::INFINITY, |a, &b| lesser(b, a));
        let most = |list: &[f32]| list.iter().fold(-f32::INFINITY, |a, &b| greater(b, a));
        self.corner = placed.each_ref().map(|list| least(list));
        self.across = self
            .cell(placed.each_ref().map(|list| most(list)))
            .map(|last| last + 1);
        self.starts.clear();
        self.starts
            .resize(self.across.iter().product::<usize>() + 1, 0);
        let number = placed[0].len();
        let cell =
            |near: &Self, i: usize| near.number(near.cell(placed.each_ref().map(|list| list[i])));
        for i in 0..number {
            let cell = cell(self, i);
            self.starts[cell] += 1;
        }
        let mut before = 0;
        for start in &mut self.starts {
            before += *start;
            *start = before;
        }
        self.points.clear();
        self.points.resize(number, 0);
        for i in 0..number {
            let cell = cell(self, i);
            self.starts[cell] -= 1;
            let place = self.starts[cell] as usize;
            self.points[place] = i as u32;
        }
    }
}

/// The scalar product of two vectors.
fn product<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    (1..D).fold(a[0] * b[0], |sum, i| sum + a[i] * b[i])
}
