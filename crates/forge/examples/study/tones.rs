//! How true the tones of a stipple are, and how even its points lie.

use std::f64::consts::PI;

use rayon::prelude::*;
use strew_forge::numeric::SplitMix;

use crate::ground::{Grid, Ground, Near};

/// The widths of Gaussians, in local spacings.
const WIDTHS: [f64; 3] = [1.0, 2.0, 4.0];
/// The standard deviations at which a Gaussian is cut off.
const REACH: f64 = 4.5;
/// Places where tones are looked at.
const PLACES: usize = 4000;

/// A picture to compare points with.
pub struct Judge<'a> {
    ground: &'a Ground<'a>,
    looks: Vec<Look>,
    /// The mean squared errors of independent points.
    chance: [f64; 3],
}

/// A place, with the picture as it is seen there through each Gaussian.
struct Look {
    at: [f64; 2],
    spreads: [f64; 3],
    tones: [f64; 3],
}

impl<'a> Judge<'a> {
    /// A judge by some sets of `count` independent points.
    pub fn new(ground: &'a Ground<'a>, grid: &Grid, count: usize, sets: u64) -> Self {
        let look = |at: [f64; 2]| {
            let spreads = WIDTHS.map(|width| width / ground.density(at).sqrt());
            Look {
                at,
                spreads,
                tones: spreads.map(|spread| tone(grid, at, spread)),
            }
        };
        let places = independent(grid, PLACES, 1).into_par_iter();
        let mut judge = Self {
            ground,
            looks: places.map(look).collect(),
            chance: [0.0; 3],
        };
        for set in 0..sets {
            let errors = judge.errors(&independent(grid, count, 1000 + set));
            judge.chance = [0, 1, 2].map(|i| judge.chance[i] + errors[i] / sets as f64);
        }
        judge
    }

    /// The mean squared relative errors of tones.
    fn errors(&self, points: &[[f64; 2]]) -> [f64; 3] {
        let each = self.looks.par_iter().map(|look| {
            let mut sums = [0.0; 3];
            for [x, y] in points {
                let squared = (x - look.at[0]).powi(2) + (y - look.at[1]).powi(2);
                for (sum, spread) in sums.iter_mut().zip(look.spreads) {
                    let squared = squared / (spread * spread);
                    if squared < REACH * REACH {
                        *sum += (-squared / 2.0).exp() / (2.0 * PI * spread * spread);
                    }
                }
            }
            [0, 1, 2].map(|i| (sums[i] / look.tones[i] - 1.0).powi(2) / PLACES as f64)
        });
        let add = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] + b[i]);
        // In order, so that the sums are the same each time.
        each.collect::<Vec<_>>().into_iter().fold([0.0; 3], add)
    }

    /// The errors of tones over those of chance, the distance of the nearest 1 % and the mean one.
    pub fn verdict(&self, points: &[[f64; 2]]) -> [f64; 5] {
        let errors = self.errors(points);
        let [a, b, c] = [0, 1, 2].map(|i| (errors[i] / self.chance[i]).sqrt());
        let near = Near::of(self.ground, points);
        [a, b, c, near.hundredth, near.mean]
    }
}

/// Independent places, spread by the densities of a grid.
fn independent(grid: &Grid, count: usize, seed: u64) -> Vec<[f64; 2]> {
    let mut random = SplitMix::new(seed);
    let mut sum = 0.0;
    let add = |v: &f64| {
        sum += v;
        sum
    };
    let sums: Vec<f64> = grid.densities.iter().map(add).collect();
    let places = (0..count).map(|_| {
        let drawn = random.next_f64() * sum;
        let i = sums.partition_point(|&v| v <= drawn).min(sums.len() - 1);
        let corner = [i % grid.columns, i / grid.columns];
        [0, 1].map(|axis| (corner[axis] as f64 + random.next_f64()) * grid.cell[axis])
    });
    places.collect()
}

/// The density of a picture through a Gaussian.
fn tone(grid: &Grid, at: [f64; 2], spread: f64) -> f64 {
    let rows = grid.densities.len() / grid.columns;
    let weights = |axis: usize, cells: usize| {
        let cell = grid.cell[axis];
        let from = ((at[axis] - REACH * spread) / cell).floor().max(0.0) as usize;
        let to = (((at[axis] + REACH * spread) / cell).ceil() as usize).min(cells);
        let weight = move |i: usize| {
            let far = ((i as f64 + 0.5) * cell - at[axis]) / spread;
            (-far * far / 2.0).exp() * cell / (spread * (2.0 * PI).sqrt())
        };
        (from, (from..to).map(weight).collect::<Vec<f64>>())
    };
    let (left, along_x) = weights(0, grid.columns);
    let (below, along_y) = weights(1, rows);
    let lines = along_y.iter().enumerate().map(|(row, weight)| {
        let line = &grid.densities[(below + row) * grid.columns + left..][..along_x.len()];
        let products = line
            .iter()
            .zip(&along_x)
            .map(|(density, weight)| density * weight);
        products.sum::<f64>() * weight
    });
    lines.sum()
}
