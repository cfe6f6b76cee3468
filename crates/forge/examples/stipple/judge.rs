//! How true the tones of a stipple are, and how even its points lie.

use std::{f64::consts::PI, fmt};

use rayon::prelude::*;

use crate::pictures::Ground;

/// The neighbor distance of the hexagonal lattice, in mean spacings.
const HEXAGONAL: f64 = 1.074_569_931_823_542;
/// The widths of Gaussians, in local spacings.
const WIDTHS: [f64; 3] = [1.0, 2.0, 4.0];
/// The standard deviations at which a Gaussian is cut off.
const REACH: f64 = 4.5;
/// Places where tones are looked at.
const PLACES: usize = 4000;

/// A picture to compare points with.
pub struct Judge<'a> {
    ground: &'a Ground,
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
    /// A judge by some sets of independent points.
    pub fn new(ground: &'a Ground, chance: u64) -> Self {
        let places = ground.chance(PLACES, 1);
        let looks = places.par_iter().map(|&at| {
            let spreads = WIDTHS.map(|width| width / ground.density(at).sqrt());
            Look {
                at,
                spreads,
                tones: spreads.map(|spread| tone(ground, at, spread)),
            }
        });
        let mut judge = Self {
            ground,
            looks: looks.collect(),
            chance: [0.0; 3],
        };
        for set in 0..chance {
            let errors = judge.errors(&ground.chance(ground.count, 1000 + set));
            judge.chance = [0, 1, 2].map(|i| judge.chance[i] + errors[i] / chance as f64);
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

    /// The errors and distances of points.
    pub fn verdict(&self, points: &[[f64; 2]], seconds: f64) -> Verdict {
        let errors = self.errors(points);
        let densities: Vec<f64> = points.iter().map(|&at| self.ground.density(at)).collect();
        let near = points.par_iter().zip(&densities).map(|(p, density)| {
            // A pair is measured by its denser point.
            let others = points.iter().zip(&densities).filter(|(q, _)| *q != p);
            let squares = others.map(|(q, other)| {
                ((p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)) * density.max(*other)
            });
            squares.fold(f64::INFINITY, f64::min).sqrt() / HEXAGONAL
        });
        let mut near: Vec<f64> = near.collect();
        near.sort_by(f64::total_cmp);
        Verdict {
            tones: [0, 1, 2].map(|i| (errors[i] / self.chance[i]).sqrt()),
            hundredth: near[near.len() / 100],
            mean: near.iter().sum::<f64>() / near.len() as f64,
            seconds,
        }
    }
}

/// The density of a picture through a Gaussian.
fn tone(ground: &Ground, at: [f64; 2], spread: f64) -> f64 {
    let rows = ground.densities.len() / ground.columns;
    let weights = |axis: usize, cells: usize| {
        let cell = ground.cell[axis];
        let from = ((at[axis] - REACH * spread) / cell).floor().max(0.0) as usize;
        let to = (((at[axis] + REACH * spread) / cell).ceil() as usize).min(cells);
        let weight = move |i: usize| {
            let far = ((i as f64 + 0.5) * cell - at[axis]) / spread;
            (-far * far / 2.0).exp() * cell / (spread * (2.0 * PI).sqrt())
        };
        (from, (from..to).map(weight).collect::<Vec<f64>>())
    };
    let (left, along_x) = weights(0, ground.columns);
    let (below, along_y) = weights(1, rows);
    let lines = along_y.iter().enumerate().map(|(row, weight)| {
        let line = &ground.densities[(below + row) * ground.columns + left..][..along_x.len()];
        let products = line
            .iter()
            .zip(&along_x)
            .map(|(density, weight)| density * weight);
        products.sum::<f64>() * weight
    });
    lines.sum()
}

/// The figures of points.
#[derive(Clone, Default)]
pub struct Verdict {
    tones: [f64; 3],
    hundredth: f64,
    mean: f64,
    seconds: f64,
}

impl Verdict {
    /// The means of some seeds, and the least time.
    pub fn of_seeds(verdicts: &[Self]) -> Self {
        let mut all = Self::default();
        for verdict in verdicts {
            all.add(verdict, verdicts.len());
        }
        let seconds = verdicts.iter().map(|verdict| verdict.seconds);
        Self {
            seconds: seconds.fold(f64::INFINITY, f64::min),
            ..all
        }
    }

    /// Adds a part of a mean.
    pub fn add(&mut self, other: &Self, parts: usize) {
        let add = |to: &mut f64, value: f64| *to += value / parts as f64;
        for (to, value) in self.tones.iter_mut().zip(other.tones) {
            add(to, value);
        }
        add(&mut self.hundredth, other.hundredth);
        add(&mut self.mean, other.mean);
        add(&mut self.seconds, other.seconds);
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [one, two, four] = self.tones;
        write!(f, "{one:.3} | {two:.3} | {four:.3} | ")?;
        write!(f, "{:.3} | {:.3} | ", self.hundredth, self.mean)?;
        match self.seconds < 0.9995 {
            true => write!(f, "{:.0} ms", self.seconds * 1000.0),
            false => write!(f, "{:.1} s", self.seconds),
        }
    }
}
