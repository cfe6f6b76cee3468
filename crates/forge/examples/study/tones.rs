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
        let cell = grid.cell[0] * grid.cell[1];
        let weights = grid.densities.iter().map(|density| density * cell);
        let cells: Vec<_> = grid.places().zip(weights).collect();
        let look = |at: [f64; 2]| {
            let spreads = WIDTHS.map(|width| width / ground.density(at).sqrt());
            Look {
                at,
                spreads,
                tones: tones(at, spreads, cells.iter().copied()),
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
            let sums = tones(look.at, look.spreads, points.iter().map(|&p| (p, 1.0)));
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

/// The density of weighted places through Gaussians around a place.
fn tones(
    at: [f64; 2],
    spreads: [f64; 3],
    places: impl Iterator<Item = ([f64; 2], f64)>,
) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for ([x, y], weight) in places {
        let squared = (x - at[0]).powi(2) + (y - at[1]).powi(2);
        for (sum, spread) in sums.iter_mut().zip(spreads) {
            let squared = squared / (spread * spread);
            if squared < REACH * REACH {
                *sum += weight * (-squared / 2.0).exp() / (2.0 * PI * spread * spread);
            }
        }
    }
    sums
}
