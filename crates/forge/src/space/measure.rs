//! Figures of points in space: power, distances, and what is left of a lattice in small windows.
//!
//! Units are those of unit density: frequencies ν in N^⅓, power 1 for white noise, distances over the densest packing's
//! (√2/N)^⅓.

use strew_core::{
    Error,
    space::{Region, SpaceSet},
};

use super::transform::transform;
use crate::numeric::SplitMix;

/// The power of a set, from its spectrum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpacePower {
    /// The number of points.
    pub points: usize,
    /// Mean power at 0 < ν < 0.5.
    pub low: f64,
    /// The greatest mean power of a shell of the spectrum.
    pub peak: f64,
    /// Where that is.
    pub peak_at: f64,
    /// The median of the shells' anisotropy beyond ν 0.8, in decibels.
    pub anisotropy: f64,
}

/// The distances of points to their nearest neighbors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpaceDistances {
    /// The least one.
    pub least: f64,
    /// The mean.
    pub mean: f64,
}

/// The power in small windows, averaged over many places: a leftover local lattice shows as spots in the ring of the peak.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalPower {
    /// The mean power in the ring of the peak.
    pub peak: f64,
    /// The deviation of its frequencies, divided by that mean.
    pub deviation: f64,
    /// The greatest power of one of its frequencies.
    pub largest: f64,
}

/// The highest frequency that is measured.
const HIGHEST: f64 = 1.6;
/// The width of a shell.
const SHELL: f64 = 0.04;

/// The sums over shells of a spectrum.
struct Shells {
    width: f64,
    sums: Vec<[f64; 4]>,
}

impl Shells {
    fn new(width: f64) -> Self {
        let count = (HIGHEST / width) as usize;
        Self {
            width,
            sums: vec![[0.0; 4]; count],
        }
    }

    fn add(&mut self, frequency: f64, power: f64) {
        if let Some(sum) = self.sums.get_mut((frequency / self.width) as usize) {
            let [number, total, squares, largest] = *sum;
            *sum = [
                number + 1.0,
                total + power,
                squares + power * power,
                largest.max(power),
            ];
        }
    }

    /// Frequency, mean, deviation over mean, and the largest of each shell.
    fn each(&self) -> impl Iterator<Item = [f64; 4]> + '_ {
        let shell = |(i, [number, total, squares, largest]): (usize, &[f64; 4])| {
            let mean = total / number.max(1.0);
            let variance = (squares / number.max(1.0) - mean * mean).max(0.0);
            [
                (i as f64 + 0.5) * self.width,
                mean,
                variance.sqrt() / mean.max(1e-12),
                *largest,
            ]
        };
        self.sums.iter().enumerate().map(shell)
    }
}

impl SpacePower {
    /// The power of points in the unit cube: of a torus, or tapered in a window of a larger set.
    #[must_use]
    pub fn of(points: &[[f64; 3]], is_torus: bool) -> Self {
        let side = (points.len() as f64).cbrt();
        let taper: Option<Vec<f64>> = (!is_torus).then(|| points.iter().map(taper).collect());
        let total = match &taper {
            Some(weights) => weights.iter().map(|w| w * w).sum(),
            None => points.len() as f64,
        };
        let modes = (HIGHEST * side).ceil() as usize;
        let mut shells = Shells::new(SHELL);
        let (mut low, mut number) = (0.0, 0.0);
        transform(points, taper.as_deref(), modes, |k, power| {
            // A taper spreads the mean to the next frequencies.
            let nearest = if is_torus { 0 } else { 1 };
            if k.iter().all(|k| k.abs() <= nearest) {
                return;
            }
            let squared: i64 = k.iter().map(|k| k * k).sum();
            let frequency = (squared as f64).sqrt() / side;
            let power = power / total;
            if frequency < 0.5 {
                low += power;
                number += 1.0;
            }
            shells.add(frequency, power);
        });
        let (mut peak, mut peak_at) = (0.0, 0.0);
        let mut uneven = Vec::new();
        for [frequency, mean, deviation, _] in shells.each() {
            if mean > peak {
                (peak, peak_at) = (mean, frequency);
            }
            if frequency > 0.8 {
                uneven.push(20.0 * deviation.max(1e-9).log10());
            }
        }
        uneven.sort_by(f64::total_cmp);
        Self {
            points: points.len(),
            low: low / f64::max(number, 1.0),
            peak,
            peak_at,
            anisotropy: uneven.get(uneven.len() / 2).copied().unwrap_or(0.0),
        }
    }

    /// The power in a cube of a set, with a side in mean spacings.
    ///
    /// # Errors
    /// As [`SpaceSet::within`].
    pub fn of_window(set: &SpaceSet, at: [f64; 3], side: f64) -> Result<Self, Error> {
        Ok(Self::of(&window(set, at, side)?, false))
    }
}

/// The Hann window of a place in the unit cube.
fn taper(p: &[f64; 3]) -> f64 {
    let turn = 2.0 * std::f64::consts::PI;
    p.iter().map(|v| 1.0 - (turn * v).cos()).product()
}

/// The points of a cube, in units of its side. `at` and `side` are in mean spacings.
fn window(set: &SpaceSet, at: [f64; 3], side: f64) -> Result<Vec<[f64; 3]>, Error> {
    let spacing = set.placement().spacing.get();
    let min = at.map(|v| v * spacing);
    let max = at.map(|v| (v + side) * spacing);
    let plan = set.within(Region::new(min, max)?)?;
    let size = side * spacing;
    let place = |p: [f64; 3]| [0, 1, 2].map(|i| (p[i] - min[i]) / size);
    Ok(plan.iter().map(|point| place(point.at())).collect())
}

impl LocalPower {
    /// The power of cubes of 12 spacings at `places` places of a set.
    ///
    /// # Errors
    /// As [`SpaceSet::within`].
    pub fn of(set: &SpaceSet, places: u32) -> Result<Self, Error> {
        const SIDE: f64 = 12.0;
        let keep = set.placement().keep.get().cbrt();
        let side = SIDE / keep;
        let modes = (HIGHEST * SIDE).ceil() as usize;
        let mut random = SplitMix::new(12);
        let mut sums: Vec<([i64; 3], f64)> = Vec::new();
        for place in 0..places {
            let at = [0; 3].map(|_| 400.0 * random.next_f64());
            let points = window(set, at, side)?;
            let weights: Vec<f64> = points.iter().map(taper).collect();
            let total: f64 = weights.iter().map(|w| w * w).sum();
            let mut next = 0;
            transform(&points, Some(&weights), modes, |k, power| {
                if place == 0 {
                    sums.push((k, 0.0));
                }
                sums[next].1 += power / total / f64::from(places);
                next += 1;
            });
        }
        let mut shells = Shells::new(0.08);
        for (k, power) in sums {
            let squared: i64 = k.iter().map(|k| k * k).sum();
            shells.add((squared as f64).sqrt() / SIDE, power);
        }
        let mut found = Self::default();
        for [frequency, mean, deviation, largest] in shells.each() {
            if frequency > 0.64 && mean > found.peak {
                found = Self {
                    peak: mean,
                    deviation,
                    largest,
                };
            }
        }
        Ok(found)
    }
}

impl SpaceDistances {
    /// The distances of the points in a cube of a set, with a side in mean spacings.
    ///
    /// # Errors
    /// As [`SpaceSet::within`].
    pub fn of_window(set: &SpaceSet, at: [f64; 3], side: f64) -> Result<Self, Error> {
        let points = window(set, at, side)?;
        let cells = (side * 0.7) as usize;
        let cell = |p: &[f64; 3]| p.map(|v| ((v * cells as f64) as usize).min(cells - 1));
        let mut lists = vec![Vec::new(); cells.pow(3)];
        for (i, p) in points.iter().enumerate() {
            let [x, y, z] = cell(p);
            lists[(z * cells + y) * cells + x].push(i);
        }
        let densest = 2f64.powf(1.0 / 6.0);
        let (mut least, mut sum, mut number) = (f64::INFINITY, 0.0, 0.0f64);
        for (i, p) in points.iter().enumerate() {
            // Neighbors of points at the sides may lie outside.
            let [x, y, z] = cell(p);
            if [x, y, z].iter().any(|&v| v == 0 || v + 1 >= cells) {
                continue;
            }
            let mut nearest = f64::INFINITY;
            for c in z - 1..=z + 1 {
                for b in y - 1..=y + 1 {
                    for a in x - 1..=x + 1 {
                        for &j in &lists[(c * cells + b) * cells + a] {
                            if i != j {
                                let q = points[j];
                                let squared: f64 = (0..3).map(|i| (p[i] - q[i]).powi(2)).sum();
                                nearest = nearest.min(squared);
                            }
                        }
                    }
                }
            }
            let distance = nearest.sqrt() * side / densest;
            least = least.min(distance);
            sum += distance;
            number += 1.0;
        }
        Ok(Self {
            least,
            mean: sum / number.max(1.0),
        })
    }
}
