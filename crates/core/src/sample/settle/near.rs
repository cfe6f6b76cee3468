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

use super::{
    cells::Places,
    freedom::root,
    plain::{greater, lesser},
};

/// The distance that two points keep beyond D, in the units of a window: more than rounding takes from it.
const SPARE: f64 = 4.0;

/// A factor for lengths: less than 1 by more than their rounding errors.
const SURELY: f64 = 1.0 - 1.0 / 262_144.0;

/// The limit of a near step, with memory to find neighbors: the points by square cells about as large as its reach.
#[derive(Clone, Debug)]
pub(super) struct Near {
    /// The distances in the units of a window: D, and the reach.
    clear: f64,
    reach: f64,
    corner: [f32; 2],
    columns: usize,
    /// By cell: the place of its first point; one more for the end.
    starts: Vec<u32>,
    points: Vec<u32>,
}

impl Near {
    pub(super) fn new(clear: f64, reach: f64) -> Self {
        Self {
            clear,
            reach,
            corner: [0.0; 2],
            columns: 0,
            starts: Vec::new(),
            points: Vec::new(),
        }
    }

    /// Shortens the moves of the points of a window from the places where they were placed.
    pub(super) fn limit(&mut self, places: &mut Places) {
        if places.len() == 0 {
            return;
        }
        self.sort(&places.placed);
        let Places { at, placed, .. } = places;
        for i in 0..placed[0].len() {
            let own = [placed[0][i], placed[1][i]];
            let go = [0, 1].map(|k| f64::from(at[k][i]) - f64::from(own[k]));
            if go != [0.0; 2] {
                let go = self.limited(placed, own, go);
                at[0][i] = own[0] + go[0];
                at[1][i] = own[1] + go[1];
            }
        }
    }

    /// The move of a point, shortened.
    fn limited(&self, placed: &[Vec<f32>; 2], own: [f32; 2], go: [f64; 2]) -> [f32; 2] {
        let free = |far: f64| (far * SURELY - self.clear - SPARE).max(0.0) * 0.5;
        let length = root(go[0] * go[0] + go[1] * go[1]);
        let mut part = (free(self.reach) / length).min(1.0);
        self.visit(placed, own, |offset, far| {
            let approach = (go[0] * offset[0] + go[1] * offset[1]) / far;
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
            let approach = f64::from(go[0]) * offset[0] + f64::from(go[1]) * offset[1];
            is_clear &= approach <= free(far) * far;
        });
        if is_clear { go } else { [0.0; 2] }
    }

    /// Calls `visit` with the offsets and distances of all points within reach of one.
    fn visit(&self, placed: &[Vec<f32>; 2], own: [f32; 2], mut visit: impl FnMut([f64; 2], f64)) {
        let [column, row] = self.cell(own);
        let rows = (self.starts.len() - 1) / self.columns;
        let columns = column.saturating_sub(1)..(column + 2).min(self.columns);
        for row in row.saturating_sub(1)..(row + 2).min(rows) {
            let [from, to] =
                [columns.start, columns.end].map(|c| self.starts[row * self.columns + c] as usize);
            for &other in &self.points[from..to] {
                let at = [0, 1].map(|k: usize| placed[k][other as usize]);
                let offset = [0, 1].map(|k: usize| f64::from(at[k]) - f64::from(own[k]));
                let far = root(offset[0] * offset[0] + offset[1] * offset[1]);
                if far > 0.0 && far < self.reach {
                    visit(offset, far);
                }
            }
        }
    }

    /// The column and the row of the cell of a place.
    fn cell(&self, at: [f32; 2]) -> [usize; 2] {
        // Somewhat larger than the reach, for what rounds.
        let side = self.reach + 1.0;
        [0, 1].map(|k: usize| ((f64::from(at[k]) - f64::from(self.corner[k])) / side) as usize)
    }

    /// Sorts places by cells.
    fn sort(&mut self, placed: &[Vec<f32>; 2]) {
        let least = |list: &[f32]| list.iter().fold(f32::INFINITY, |a, &b| lesser(b, a));
        let most = |list: &[f32]| list.iter().fold(-f32::INFINITY, |a, &b| greater(b, a));
        self.corner = [0, 1].map(|k: usize| least(&placed[k]));
        let [last_column, last_row] = self.cell([0, 1].map(|k: usize| most(&placed[k])));
        self.columns = last_column + 1;
        self.starts.clear();
        self.starts.resize(self.columns * (last_row + 1) + 1, 0);
        let number = placed[0].len();
        let cell = |near: &Self, i: usize| {
            let [column, row] = near.cell([placed[0][i], placed[1][i]]);
            row * near.columns + column
        };
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
