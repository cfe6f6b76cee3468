//! The distances between neighbors.

use super::points::SpacePoints;
use crate::{cell_list::CellList, measure::least_and_mean};

/// The distances of points to their nearest neighbors, over that of the densest packing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpaceDistances {
    /// The least one.
    pub least: f64,
    /// The mean.
    pub mean: f64,
}

/// The distance of the densest packing at unit density: the sixth root of 2.
const DENSEST: f64 = 1.122_462_048_309_373;
/// The least side of a cell, in mean spacings: farther than most nearest neighbors.
const CELL: f64 = 1.4;

impl SpaceDistances {
    /// The distances of points to their nearest neighbors. Points in the cells at the sides of a window do not count:
    /// their neighbors may lie outside.
    #[must_use]
    pub fn of(set: &SpacePoints) -> Self {
        let per_axis = ((set.side() / CELL) as i64).max(1);
        let cells = CellList::new(set.points(), 1.0, set.is_torus(), per_axis);
        let counts = |p: &[f64; 3]| set.is_torus() || cells.is_within(p);
        let [least, mean] = least_and_mean(&cells, counts).map(|v| v * set.side() / DENSEST);
        Self { least, mean }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    #[test]
    fn distances_are_those_of_all_pairs() {
        let mut random = SplitMix::new(2);
        let mut next = || random.next_f64();
        let points: Vec<[f64; 3]> = (0..700).map(|_| [next(), next(), next()]).collect();
        let set = SpacePoints::new(points, true);
        let between = |i: usize, j: usize, axis: usize| {
            let d = (set.points()[i][axis] - set.points()[j][axis]).abs();
            d.min(1.0 - d) * d.min(1.0 - d)
        };
        let nearest = |i: usize| {
            let others = (0..700).filter(|&j| j != i);
            let all = others.map(|j| (0..3).map(|axis| between(i, j, axis)).sum::<f64>());
            all.fold(f64::INFINITY, f64::min).sqrt() * set.side() / DENSEST
        };
        let all: Vec<f64> = (0..700).map(nearest).collect();
        let found = SpaceDistances::of(&set);
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((found.least - least).abs() < 1e-12);
        assert!((found.mean - all.iter().sum::<f64>() / 700.0).abs() < 1e-9);
    }
}
