//! The distances between neighbors.

use super::points::SpacePoints;

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
    /// The distances of points to the nearest one in the same cell or a next one. Points at the sides of a window do not
    /// count: their neighbors may lie outside.
    #[must_use]
    pub fn of(set: &SpacePoints) -> Self {
        let cells = ((set.side() / CELL) as i64).max(1);
        let cell = |p: &[f64; 3]| p.map(|v| ((v * cells as f64) as i64).min(cells - 1));
        let place = |[x, y, z]: [i64; 3]| ((z * cells + y) * cells + x) as usize;
        let mut lists = vec![Vec::new(); cells.pow(3) as usize];
        for (i, p) in set.points().iter().enumerate() {
            lists[place(cell(p))].push(i);
        }
        // Each cell once, if there are fewer than three.
        let around = |v: i64| (v - 1..=v + 1).take(cells as usize);
        let (mut least, mut sum, mut number) = (f64::INFINITY, 0.0, 0.0f64);
        for (i, p) in set.points().iter().enumerate() {
            let own = cell(p);
            if !set.is_torus() && own.iter().any(|&v| v == 0 || v + 1 >= cells) {
                continue;
            }
            let mut nearest = f64::INFINITY;
            for c in around(own[2]) {
                for b in around(own[1]) {
                    for a in around(own[0]) {
                        let other = [a, b, c].map(|v| v.rem_euclid(cells));
                        for &j in lists[place(other)].iter().filter(|&&j| i != j) {
                            let squared: f64 = (0..3).map(|axis| set.between(i, j, axis)).sum();
                            nearest = nearest.min(squared);
                        }
                    }
                }
            }
            if nearest < f64::INFINITY {
                let distance = nearest.sqrt() * set.side() / DENSEST;
                least = least.min(distance);
                sum += distance;
                number += 1.0;
            }
        }
        Self {
            least: if number > 0.0 { least } else { 0.0 },
            mean: sum / number.max(1.0),
        }
    }
}

impl SpacePoints {
    /// The squared difference of two points along an axis, in units of the cube's side.
    fn between(&self, i: usize, j: usize, axis: usize) -> f64 {
        let d = (self.points()[i][axis] - self.points()[j][axis]).abs();
        let d = if self.is_torus() { d.min(1.0 - d) } else { d };
        d * d
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
        let nearest = |i: usize| {
            let others = (0..700).filter(|&j| j != i);
            let all = others.map(|j| (0..3).map(|axis| set.between(i, j, axis)).sum::<f64>());
            all.fold(f64::INFINITY, f64::min).sqrt() * set.side() / DENSEST
        };
        let all: Vec<f64> = (0..700).map(nearest).collect();
        let found = SpaceDistances::of(&set);
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((found.least - least).abs() < 1e-12);
        assert!((found.mean - all.iter().sum::<f64>() / 700.0).abs() < 0.01);
    }
}
