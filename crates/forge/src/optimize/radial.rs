//! A radial power curve as an energy in table space: no point set, only frequencies of pairs.
//!
//! The radial power of a set is P(ν) = 1 + Σ J₀(2πνr) over the distances r from a point to all
//! others, less what a uniform density gives. So it is linear in the histogram of distances, and
//! the histogram comes exactly from the frequencies of block pairs (see [`Pairs`]): of the unbounded
//! pattern, not of a sample of it. Distances beyond a reach are tapered away, which blurs P by about
//! 1/reach; the target is blurred alike. One evaluation is a pass over the pairs for the histogram,
//! a product with a table of J₀, and a second pass with the resulting force, a function of the
//! distance alone.

use rayon::prelude::*;

use super::{Objective, Pairs, pairs::CHUNK};
use crate::{
    energy::{BesselJ0, PairEnergy},
    profile::Target,
};

/// Bins of the histogram per mean spacing. A distance counts in two of them, in proportion.
const BINS: f64 = 128.0;
/// Rings per unit of ν: about twice as many as the reach resolves.
const RINGS: f64 = 40.0;
/// Steps per unit of ν in the integral that gives a target's own distances.
const TARGET_STEPS: f64 = 2000.0;

/// The cost of the squared excess of a vector's length over the leash.
const PULL: f64 = 0.3;

/// What a curve's error costs; see [`Radial`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialWeights {
    /// Pairs up to this distance count, in mean spacings. Resolution is about 1/reach; cost grows
    /// as its square or faster.
    pub reach: f64,
    /// The largest ν that is fitted.
    pub nu_max: f64,
    /// The cost of the squared error, per unit of ν.
    pub fit: f64,
    /// The cost of power as such, per unit area of the (νx, νy) plane, where the target is 0. The
    /// square alone would lose its slope long before such power is gone.
    pub quiet: f64,
    /// Vectors longer than this, in mean spacings, are pulled back: what samples the set looks that
    /// far around every region.
    pub leash: f64,
    /// Power as such costs less and less over this width in ν before the target leaves 0.
    pub edge: f64,
}

/// Rings, each with its own cost.
#[derive(Clone, Debug)]
struct Ring {
    target: f64,
    fit: f64,
    quiet: f64,
}

/// The error of a radial power curve: Σ fit·(P − T)² + quiet·P over rings.
pub struct Radial {
    pairs: Pairs<Reach>,
    leash: f64,
    bins: usize,
    rings: Vec<Ring>,
    /// By ring, then bin: J₀ times the taper.
    waves: Vec<f64>,
    /// What a uniform density gives, by bin.
    uniform: Vec<f64>,
}

/// No energy of its own; it tells how far pairs matter.
pub struct Reach(pub f64);

impl PairEnergy for Reach {
    fn cutoff(&self) -> f64 {
        self.0
    }

    fn pair(&self, _: f64) -> (f64, f64) {
        (0.0, 0.0)
    }
}

impl Radial {
    /// The error of `target` for the patterns and the scale of `pairs`.
    #[must_use]
    pub fn new(pairs: Pairs<Reach>, target: &Target, weights: &RadialWeights) -> Self {
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
            .map(|bin| uniform[bin] * excess(target, &bessel, r(bin)))
            .collect();
        let rings = waves
            .par_chunks_exact(bins)
            .enumerate()
            .map(|(ring, wave)| Ring {
                target: 1.0 + wave.iter().zip(&own).map(|(w, h)| w * h).sum::<f64>(),
                fit: weights.fit / RINGS,
                quiet: weights.quiet * two_pi * nu(ring) / RINGS
                    * quietness(target, nu(ring), weights.edge),
            })
            .collect();
        Self {
            pairs,
            leash: weights.leash,
            bins,
            rings,
            waves,
            uniform,
        }
    }

    /// The blurred target and the blurred power for the given moves: (ν, target, power).
    pub fn curves(&mut self, moves: &[[f64; 2]]) -> Vec<[f64; 3]> {
        self.pairs.refresh(moves);
        let power = self.power(&self.histogram(moves));
        let nus = (0..power.len()).map(|ring| ring as f64 / RINGS);
        nus.zip(&self.rings)
            .zip(power)
            .map(|((nu, ring), power)| [nu, ring.target, power])
            .collect()
    }

    /// Neighbors per point and bin, in excess of a uniform density.
    fn histogram(&self, moves: &[[f64; 2]]) -> Vec<f64> {
        let masses = self.pairs.masses();
        let partial: Vec<Vec<f64>> = moves
            .par_chunks(CHUNK)
            .enumerate()
            .map(|(chunk, own)| {
                let mut bins = vec![0.0; self.bins + 1];
                for (at, &own) in own.iter().enumerate() {
                    let block = chunk * CHUNK + at;
                    self.each_pair(block, own, moves, |weight, at, _, _| {
                        let (bin, share) = (at as usize, at - (at as usize) as f64);
                        let weight = weight * masses[block];
                        bins[bin] += weight * (1.0 - share);
                        bins[bin + 1] += weight * share;
                    });
                }
                bins
            })
            .collect();
        let mut sum: Vec<f64> = self.uniform.iter().map(|u| -u).collect();
        for bins in partial {
            sum.iter_mut().zip(bins).for_each(|(sum, bin)| *sum += bin);
        }
        sum
    }

    /// Calls `visit` with the weight of each pair of a block, its distance in bins, and the vector
    /// from the neighbor to the block's own point.
    #[inline]
    fn each_pair(
        &self,
        block: usize,
        own: [f64; 2],
        moves: &[[f64; 2]],
        mut visit: impl FnMut(f64, f64, f64, f64),
    ) {
        let scale = self.pairs.scale();
        let last = (self.bins - 1) as f64;
        for pair in self.pairs.list(block) {
            let to = moves[pair.to as usize];
            let dx = own[0] - (scale * f64::from(pair.i) + to[0]);
            let dy = own[1] - (scale * f64::from(pair.j) + to[1]);
            let at = (dx * dx + dy * dy).sqrt() * BINS;
            if at < last {
                visit(f64::from(pair.weight), at, dx, dy);
            }
        }
    }

    /// The cost of vectors that are too long; adds its slope.
    fn pull(&self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        let mut cost = 0.0;
        for ((m, slope), mass) in moves.iter().zip(gradient).zip(self.masses()) {
            let length = (m[0] * m[0] + m[1] * m[1]).sqrt();
            let excess = length - self.leash;
            if excess > 0.0 {
                cost += mass * PULL * excess * excess;
                let factor = 2.0 * PULL * excess / length;
                slope[0] += factor * m[0];
                slope[1] += factor * m[1];
            }
        }
        cost
    }

    fn power(&self, histogram: &[f64]) -> Vec<f64> {
        self.waves
            .par_chunks_exact(self.bins)
            .map(|wave| 1.0 + wave.iter().zip(histogram).map(|(w, h)| w * h).sum::<f64>())
            .collect()
    }

    /// The slope of the energy by the distance of a pair seen from one end, by bin.
    fn force(&self, power: &[f64]) -> Vec<f64> {
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
            .collect()
    }
}

impl Objective for Radial {
    fn masses(&self) -> &[f64] {
        self.pairs.masses()
    }

    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        self.pairs.refresh(moves);
        let power = self.power(&self.histogram(moves));
        let force = self.force(&power);
        gradient
            .par_chunks_mut(CHUNK)
            .enumerate()
            .for_each(|(chunk, out)| {
                for (at, out) in out.iter_mut().enumerate() {
                    let block = chunk * CHUNK + at;
                    let mut slope = [0.0; 2];
                    self.each_pair(block, moves[block], moves, |weight, at, dx, dy| {
                        let along = weight * force[at as usize] * (BINS / at.max(1e-6));
                        slope[0] += along * dx;
                        slope[1] += along * dy;
                    });
                    *out = slope;
                }
            });
        let costs = self.rings.iter().zip(power).map(|(ring, power)| {
            let error = power - ring.target;
            ring.fit * error * error + ring.quiet * power
        });
        costs.sum::<f64>() + self.pull(moves, gradient)
    }

    fn prepared_for(&self) -> &[[f64; 2]] {
        self.pairs.prepared_for()
    }

    fn prepare_for(&mut self, moves: &[[f64; 2]]) {
        self.pairs.prepare_for(moves);
    }

    fn pairs(&self) -> usize {
        self.pairs.pairs()
    }
}

/// (1 − x²)³: smooth to the second derivative at the reach, so that the blur has low tails.
fn taper(x: f64) -> f64 {
    let rest = (1.0 - x * x).max(0.0);
    rest * rest * rest
}

/// g(r) − 1 of a set with that spectrum: the transform of T − 1. It cannot be below −1.
pub(crate) fn excess(target: &Target, bessel: &BesselJ0, r: f64) -> f64 {
    let two_pi = 2.0 * std::f64::consts::PI;
    let steps = (target.end() * TARGET_STEPS) as usize;
    let sum: f64 = (0..=steps)
        .map(|step| {
            let nu = (step as f64 + 0.5) / TARGET_STEPS;
            (target.at(nu) - 1.0) * nu * bessel.at(two_pi * nu * r)
        })
        .sum();
    two_pi * sum / TARGET_STEPS
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

#[cfg(test)]
mod tests {
    use strew_core::{Map, Table, Twin, table::Provenance, table::from_grid_units};

    use super::*;
    use crate::{
        measure::{Spectrum, twin_set},
        optimize::jitter,
    };

    const WEIGHTS: RadialWeights = RadialWeights {
        reach: 9.0,
        nu_max: 2.0,
        fit: 1.0,
        quiet: 0.5,
        leash: 0.5,
        edge: 0.1,
    };

    fn step() -> Target {
        "0 0\n0.5 0\n0.5 1".parse().expect("valid")
    }

    fn map() -> Map {
        Map::new("(5-sqrt(3))/2".parse().expect("valid"), 20).expect("small")
    }

    fn objective(map: &Map) -> Radial {
        let scale = map.alpha().set_side_f64();
        let pairs = Pairs::new(Reach(WEIGHTS.reach), std::slice::from_ref(map), scale);
        Radial::new(pairs, &step(), &WEIGHTS)
    }

    #[test]
    fn its_gradient_is_that_of_its_energy() {
        let map = map();
        let mut radial = objective(&map);
        let blocks = map.intervals() * map.intervals();
        let moves = jitter(blocks, 0.8, 3);
        let mut gradient = vec![[0.0; 2]; blocks];
        radial.evaluate(&moves, &mut gradient);
        for block in [7, 200, 431] {
            for axis in 0..2 {
                let mut at = |by: f64| {
                    let mut moves = moves.clone();
                    moves[block][axis] += by;
                    radial.evaluate(&moves, &mut vec![[0.0; 2]; blocks])
                };
                let numeric = (at(1e-6) - at(-1e-6)) / 2e-6;
                let found = gradient[block][axis] * radial.masses()[block];
                assert!(
                    (found - numeric).abs() < 1e-4 * numeric.abs().max(1e-4),
                    "{found} {numeric}"
                );
            }
        }
    }

    #[test]
    fn its_power_is_that_of_the_points() {
        let map = map();
        let scale = map.alpha().set_side_f64();
        let moves = jitter(map.intervals() * map.intervals(), 1.5, 5);
        let curves = objective(&map).curves(&moves);
        let grid = |v: f64| from_grid_units(v / scale).expect("short");
        let vectors = moves.iter().map(|m| m.map(grid)).collect();
        let table = Table::new(map, "some", vectors, Provenance::default()).expect("valid");
        let twin = Twin::new(265 + 418, 418).expect("coprime");
        let set = twin_set(&table, twin).expect("a twin");
        let rings = Spectrum::of_torus(&set, 2.1).rings(0.1);
        // Both blurred to about the same width, where neither the mean density nor the end shows.
        for ring in rings.iter().filter(|r| (0.3..1.9).contains(&r.nu)) {
            let near = curves.iter().filter(|c| (c[0] - ring.nu).abs() < 0.05);
            let (sum, count) = near.fold((0.0, 0.0), |(s, n), c| (s + c[2], n + 1.0));
            let found: f64 = sum / count;
            assert!(
                (found - ring.power).abs() < 0.15 * ring.power.max(0.5),
                "{ring:?} {found}"
            );
        }
    }

    #[test]
    fn a_step_leaves_no_room_for_a_pair_at_distance_zero() {
        let bessel = BesselJ0::up_to(60.0);
        let at_most: Target = "0 0\n0.5642 0\n0.5642 1".parse().expect("valid");
        assert!((excess(&at_most, &bessel, 0.0) + 1.0).abs() < 1e-3);
        // −ν₀·J₁(2πν₀r)/r, the transform of a disk.
        let (nu, r): (f64, f64) = (0.5, 1.7);
        let turn = |node: i32| std::f64::consts::PI * (f64::from(node) + 0.5) / 400.0;
        let x = std::f64::consts::TAU * nu * r;
        let j1: f64 = (0..400)
            .map(|node| (turn(node) - x * turn(node).sin()).cos())
            .sum::<f64>()
            / 400.0;
        assert!((excess(&step(), &bessel, r) + nu * j1 / r).abs() < 1e-3);
    }
}
