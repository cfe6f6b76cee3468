//! The radial power of a histogram of distances, and the cost of its error against a target.
//!
//! The radial power of a set is P(ν) = 1 + Σ J₀(2πνr), where r runs over the distances from a point
//! to all others, less the same sum for a uniform density. So P is linear in the histogram of
//! distances. Distances are tapered off towards a reach, which blurs P by about 1/reach. The target
//! is blurred in the same way.

use rayon::prelude::*;

use crate::{
    curve::{Target, total_correlation},
    numeric::BesselJ0,
};

/// Bins of the histogram per mean spacing.
pub(super) const BINS_PER_SPACING: f64 = 128.0;
/// Rings per unit of ν: about twice as many as the reach resolves.
pub(super) const RINGS_PER_NU: f64 = 40.0;
/// Below this ν, power as such costs more than its area in the (νx, νy) plane; see [`extent`].
const LONG_WAVES: f64 = 0.2;

/// The weights in the cost of a power curve's error, and the range it is taken over; see
/// [`Radial`](super::Radial). Lengths are in mean spacings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialWeights {
    /// Pairs up to this distance count. The resolution in ν is about 1/reach; run time grows as the
    /// square of the reach or faster.
    pub reach: f64,
    /// The largest ν that is fitted.
    pub nu_max: f64,
    /// The cost of the squared error, per unit of ν. Where the target T is above 1 it is divided by
    /// T: a compromise between absolute and relative error.
    pub fit: f64,
    /// The cost of power as such where the target is 0, per unit area of the (νx, νy) plane, and
    /// more at the lowest ν. The slope of the squared error alone vanishes long before such power
    /// is gone.
    pub quiet: f64,
    /// Vectors longer than this are pulled back, because a sampler has to look as far around every
    /// region as the longest vector reaches.
    pub leash: f64,
    /// The width in ν over which `quiet` falls to 0 at the ends of a band where the target is 0.
    pub edge: f64,
}

/// Rings from ν = 0 on, each with its target and its weights.
pub(super) struct Rings {
    /// The number of bins of a histogram.
    pub(super) bins: usize,
    rings: Vec<Ring>,
    /// By ring, then bin: J₀ times the taper.
    waves: Vec<f64>,
    /// The histogram of a uniform density, by bin.
    uniform: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Ring {
    /// Blurred.
    target: f64,
    fit: f64,
    quiet: f64,
}

impl Rings {
    pub(super) fn new(target: &Target, weights: &RadialWeights) -> Self {
        let bins = (weights.reach * BINS_PER_SPACING) as usize + 1;
        let count = (weights.nu_max * RINGS_PER_NU) as usize + 1;
        let two_pi = 2.0 * std::f64::consts::PI;
        let bessel =
            BesselJ0::up_to(two_pi * (weights.nu_max.max(target.end()) + 1.0) * weights.reach);
        let nu = |ring: usize| ring as f64 / RINGS_PER_NU;
        let r = |bin: usize| bin as f64 / BINS_PER_SPACING;
        let waves: Vec<f64> = (0..count * bins)
            .into_par_iter()
            .map(|at| {
                let (ring, bin) = (at / bins, at % bins);
                taper(r(bin) / weights.reach) * bessel.at(two_pi * nu(ring) * r(bin))
            })
            .collect();
        let uniform: Vec<f64> = (0..bins)
            .map(|bin| two_pi * r(bin) / BINS_PER_SPACING)
            .collect();
        // The histogram of a set with the target's power, in excess of a uniform density.
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
                    fit: weights.fit / (RINGS_PER_NU * blurred.max(1.0)),
                    quiet: weights.quiet * two_pi * extent(nu(ring)) / RINGS_PER_NU
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

    /// The histogram of a point without neighbors, in excess of a uniform density: negative.
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

    /// The derivative of the cost by the distance of a pair, seen from one end, for each distance
    /// bin; 0 in the last.
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
            .map(|ends| 2.0 * BINS_PER_SPACING * (ends[1] - ends[0]))
            .chain([0.0])
            .collect()
    }
}

/// The weight of a ring of power as such: its circumference over 2π, and more where ν is small.
/// There moves change the power only in proportion to ν, so it would be the last to go.
fn extent(nu: f64) -> f64 {
    nu + LONG_WAVES * LONG_WAVES / nu.max(1.0 / RINGS_PER_NU)
}

/// The taper (1 − x²)³, with x the distance over the reach. It is smooth to the second derivative
/// at x = 1, so the blur has low tails.
fn taper(x: f64) -> f64 {
    let rest = (1.0 - x * x).max(0.0);
    rest * rest * rest
}

/// 1 well inside a band where the target is 0, falling to 0 within `edge` of the band's ends.
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
