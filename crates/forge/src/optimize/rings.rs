//! What a radial power curve asks of the distances between points, and what missing it costs.
//!
//! The radial power of a set is P(ν) = 1 + Σ J₀(2πνr) over the distances r from a point to all
//! others, less what a uniform density gives: it is linear in the histogram of distances. Distances
//! beyond a reach are tapered away, which blurs P by about 1/reach; the target is blurred alike.

use rayon::prelude::*;

use super::RadialWeights;
use crate::{
    curve::{Target, total_correlation},
    numeric::BesselJ0,
};

/// Bins of the histogram per mean spacing.
pub(super) const BINS: f64 = 128.0;
/// Rings per unit of ν: about twice as many as the reach resolves.
pub(super) const RINGS: f64 = 40.0;
/// Below this ν power costs more than its area in the (νx, νy) plane.
const LONG_WAVES: f64 = 0.2;
/// Rings of ν from 0 on, each with its target and its own cost.
pub(super) struct Rings {
    bins: usize,
    rings: Vec<Ring>,
    /// By ring, then bin: J₀ times the taper.
    waves: Vec<f64>,
    /// What a uniform density gives, by bin.
    uniform: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Ring {
    target: f64,
    fit: f64,
    quiet: f64,
}

impl Rings {
    pub(super) fn new(target: &Target, weights: &RadialWeights) -> Self {
        let bins = (weights.reach * BINS) as usize + 1;
        let count = (weights.nu_max * RINGS) as usize + 1;
        let two_pi = 2.0 * std::f64::consts::PI;
        let bessel =
            BesselJ0::up_to(two_pi * (weights.nu_max.max(target.end()) + 1.0) * weights.reach);
        let nu = |ring: usize| ring as f64 / RINGS;
        let r = |bin: usize| bin as f64 / BINS;
        let waves: Vec<f64> = (0..count * bins)
            .into_par_iter()
            .map(|at| {
                let (ring, bin) = (at / bins, at % bins);
                taper(r(bin) / weights.reach) * bessel.at(two_pi * nu(ring) * r(bin))
            })
            .collect();
        let uniform: Vec<f64> = (0..bins).map(|bin| two_pi * r(bin) / BINS).collect();
        // What the target's own set would have in each bin beyond a uniform density.
        let own: Vec<f64> = (0..bins)
            .into_par_iter()
            .map(|bin| uniform[bin] * total_correlation(target, &bessel, r(bin)))
            .collect();
        let rings = waves
            .par_chunks_exact(bins)
            .enumerate()
            .map(|(ring, wave)| {
                let blurred = 1.0 + wave.iter().zip(&own).map(|(w, h)| w * h).sum::<f64>();
                Ring {
                    target: blurred,
                    fit: weights.fit / (RINGS * blurred.max(1.0)),
                    quiet: weights.quiet * two_pi * extent(nu(ring)) / RINGS
                        * quietness(target, nu(ring), weights.edge),
                }
            })
            .collect();
        Self {
            bins,
            rings,
            waves,
            uniform,
        }
    }

    /// How many bins a histogram has.
    pub(super) const fn bins(&self) -> usize {
        self.bins
    }

    /// A histogram without any neighbors: in excess of a uniform density, less than none.
    pub(super) fn empty(&self) -> Vec<f64> {
        self.uniform.iter().map(|u| -u).collect()
    }

    /// The blurred target of each ring.
    pub(super) fn targets(&self) -> impl Iterator<Item = f64> {
        self.rings.iter().map(|ring| ring.target)
    }

    /// The blurred power of each ring.
    pub(super) fn power(&self, histogram: &[f64]) -> Vec<f64> {
        self.waves
            .par_chunks_exact(self.bins)
            .map(|wave| 1.0 + wave.iter().zip(histogram).map(|(w, h)| w * h).sum::<f64>())
            .collect()
    }

    /// Σ fit·(P − T)² + quiet·P.
    pub(super) fn cost(&self, power: &[f64]) -> f64 {
        let costs = self.rings.iter().zip(power).map(|(ring, power)| {
            let error = power - ring.target;
            ring.fit * error * error + ring.quiet * power
        });
        costs.sum()
    }

    /// The slope of the cost by the distance of a pair seen from one end, by bin; none in the last.
    pub(super) fn force(&self, power: &[f64]) -> Vec<f64> {
        let slopes = self.rings.iter().zip(power);
        let slopes: Vec<f64> = slopes
            .map(|(ring, power)| 2.0 * ring.fit * (power - ring.target) + ring.quiet)
            .collect();
        let mut potential = vec![0.0; self.bins];
        for (wave, slope) in self.waves.chunks_exact(self.bins).zip(slopes) {
            for (sum, w) in potential.iter_mut().zip(wave) {
                *sum += slope * w;
            }
        }
        // A pair is seen from both of its ends.
        potential
            .windows(2)
            .map(|ends| 2.0 * BINS * (ends[1] - ends[0]))
            .chain([0.0])
            .collect()
    }
}

/// What counts as a ring's circumference, over 2π: more than ν where ν is small. There power yields
/// to moves by its wavelength's inverse only, and would be gone last.
fn extent(nu: f64) -> f64 {
    nu + LONG_WAVES * LONG_WAVES / nu.max(1.0 / RINGS)
}

/// (1 − x²)³: smooth to the second derivative at the reach, so that the blur has low tails.
fn taper(x: f64) -> f64 {
    let rest = (1.0 - x * x).max(0.0);
    rest * rest * rest
}

/// 1 well inside a band where the target is 0, falling to 0 over `edge` before the band's ends.
fn quietness(target: &Target, nu: f64, edge: f64) -> f64 {
    if target.at(nu) > 0.0 {
        return 0.0;
    }
    let steps = 64;
    let inside = (1..=steps).map(|step| edge * f64::from(step) / f64::from(steps));
    let free = inside
        .take_while(|by| target.at(nu + by) <= 0.0 && target.at((nu - by).max(0.0)) <= 0.0)
        .count();
    let u = free as f64 / f64::from(steps);
    u * u * (3.0 - 2.0 * u)
}
