//! Pixels that are missing from a grid: which places lie in one, and what lies beside.
//!
//! All of it is off the path of grids without gaps, which know that they have none.

use super::grid::{Edges, Grid};
use crate::shape::Region;

impl Grid {
    /// The mean of those pixels that are there, by their weights; none if all are there.
    #[cold]
    pub(super) fn mean_of_present(
        &self,
        [left, right]: [usize; 2],
        [bottom, top]: [usize; 2],
        [u, v]: [f64; 2],
        pixel: impl Fn(usize) -> f32,
    ) -> Option<f64> {
        let of = |row: usize, column: usize| row * self.size[0] + column;
        let corners = [
            (of(bottom, left), (1.0 - u) * (1.0 - v)),
            (of(bottom, right), u * (1.0 - v)),
            (of(top, left), (1.0 - u) * v),
            (of(top, right), u * v),
        ];
        let present = corners.into_iter().filter(|(at, _)| self.pixels.has(*at));
        let [number, sum, weight] = present.fold([0.0; 3], |[number, sum, all], (at, weight)| {
            let part = weight * f64::from(pixel(at));
            [number + 1.0, sum + part, all + weight]
        });
        match weight > 0.0 {
            true if number == 4.0 => None,
            true => Some(sum / weight),
            // A place in a missing pixel.
            false => Some(0.0),
        }
    }

    /// Whether a place lies in a pixel that is missing.
    #[inline]
    pub(super) fn is_missing(&self, at: [f64; 2]) -> bool {
        self.is_partial && self.is_in_missing(at)
    }

    #[cold]
    fn is_in_missing(&self, at: [f64; 2]) -> bool {
        if self.edges == Edges::Zero && !self.region.contains(at) {
            return false;
        }
        let [column, row] =
            [0, 1].map(|axis| (self.place(axis, at[axis]) as usize).min(self.size[axis] - 1));
        !self.pixels.has(row * self.size[0] + column)
    }

    /// Whether a place of a box may be in a missing pixel, and whether all are.
    pub(super) fn missing(&self, within: &Region) -> [bool; 2] {
        let Some(present) = self.pixels.present() else {
            return [false; 2];
        };
        match self.bounds_of(present, within) {
            (Some([low, high]), is_outside) => [low < 1.0, high <= 0.0 && !is_outside],
            (None, _) => [false; 2],
        }
    }
}
