//! A radial power curve as an energy in table space.
//!
//! The radial power follows from the histogram of distances (see [`Rings`]). Exact pair frequencies
//! (see [`Neighbors`]) yield the histogram of the unbounded pattern, without a
//! sample of points. One evaluation is a pass over the pairs for the histogram, a product with a
//! table of J₀, and a second pass with the resulting force, which depends on the distance alone.
//!
//! A map serves an interval of α, and across it the frequencies of far pairs change completely:
//! blocks shrink to nothing, others begin to meet. A table that follows its curve at one α misses
//! it at the ends of the interval, where some twins lie. So the error is evaluated at several α and
//! averaged. Averaging the histograms instead would let opposite errors cancel.

use rayon::prelude::*;
use strew_core::Map;

use super::{
    Objective,
    ground::Pair,
    pairs::{CHUNK, LANES, Neighbors},
    rings::{BINS_PER_SPACING, RINGS_PER_NU, RadialWeights, Rings},
};
use crate::curve::Target;

/// The cost of the squared excess of a vector's length over the leash.
const PULL: f64 = 0.3;

/// The error of a radial power curve: Σ fit·(P − T)² + quiet·P over rings, averaged over patterns.
pub struct Radial {
    patterns: Vec<WeightedPattern>,
    masses: Vec<f64>,
    leash: f64,
    rings: Rings,
}

/// The pattern of the map at one α.
struct WeightedPattern {
    neighbors: Neighbors,
    /// Mean spacings of this pattern per mean spacing of the table.
    stretch: f64,
    /// Its weight in the average.
    share: f64,
}

impl Radial {
    /// The error against `target`, averaged over the patterns of `maps` by their shares, which sum
    /// to 1. The maps are one map for slightly different α; lengths are in mean
    /// spacings of the first.
    pub fn new(maps: &[(Map, f64)], target: &Target, weights: &RadialWeights) -> Self {
        let scale = maps[0].0.alpha().set_side_f64();
        let pattern = |(map, share): &(Map, f64)| WeightedPattern {
            neighbors: Neighbors::new(weights.reach, std::slice::from_ref(map), scale),
            stretch: map.alpha().set_side_f64() / scale,
            share: *share,
        };
        let patterns: Vec<WeightedPattern> = maps.iter().map(pattern).collect();
        let mut masses = vec![0.0; patterns[0].neighbors.masses.len()];
        for pattern in &patterns {
            for (sum, mass) in masses.iter_mut().zip(&pattern.neighbors.masses) {
                *sum += pattern.share * mass;
            }
        }
        Self {
            patterns,
            masses,
            leash: weights.leash,
            rings: Rings::new(target, weights),
        }
    }

    /// Target and power of the first map's pattern for the given moves, both blurred:
    /// (ν, target, power), ascending in ν.
    pub fn curves(&mut self, moves: &[[f64; 2]]) -> Vec<[f64; 3]> {
        let first = &mut self.patterns[0];
        first.neighbors.refresh(moves);
        let power = self.rings.power(&first.histogram(&self.rings, moves));
        let nus = (0..power.len()).map(|ring| ring as f64 / RINGS_PER_NU);
        nus.zip(self.rings.targets())
            .zip(power)
            .map(|((nu, target), power)| [nu, target, power])
            .collect()
    }

    /// Returns the cost of vectors longer than the leash and adds its slope to `gradient`.
    fn pull(&self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        let mut cost = 0.0;
        for ((m, slope), mass) in moves.iter().zip(gradient).zip(&self.masses) {
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
}

impl WeightedPattern {
    /// The mean number of neighbors of a point, by distance bin, in excess of a uniform density.
    fn histogram(&self, rings: &Rings, moves: &[[f64; 2]]) -> Vec<f64> {
        let masses = &self.neighbors.masses;
        let partial: Vec<Vec<f64>> = moves
            .par_chunks(CHUNK)
            .enumerate()
            .map(|(chunk, own)| {
                let mut bins = vec![0.0; rings.bins + 1];
                for (at, &own) in own.iter().enumerate() {
                    let block = chunk * CHUNK + at;
                    let list = &self.neighbors.lists[block];
                    // A pair is in the lists of both its blocks, with opposite offsets: half of
                    // each list, counted twice, covers all pairs.
                    let half = list.partition_point(|pair| (pair.j, pair.i) < (0, 0));
                    let mass = 2.0 * masses[block];
                    self.each_pair(&list[half..], own, moves, rings.bins, |weight, at, _, _| {
                        let (bin, share) = (at as usize, at - (at as usize) as f64);
                        let weight = weight * mass;
                        bins[bin] += weight * (1.0 - share);
                        bins[bin + 1] += weight * share;
                    });
                }
                bins
            })
            .collect();
        let mut sum = rings.empty();
        for bins in partial {
            sum.iter_mut().zip(bins).for_each(|(sum, bin)| *sum += bin);
        }
        sum
    }

    /// Adds the slope of all blocks under a force to `to`. `force` is by distance bin, `mean` holds
    /// the masses of the blocks averaged over all patterns.
    fn add_slope(&self, force: &[f64], moves: &[[f64; 2]], mean: &[f64], to: &mut [[f64; 2]]) {
        let masses = &self.neighbors.masses;
        to.par_chunks_mut(CHUNK)
            .enumerate()
            .for_each(|(chunk, out)| {
                for (at, out) in out.iter_mut().enumerate() {
                    let block = chunk * CHUNK + at;
                    let mut slope = [0.0; 2];
                    let list = &self.neighbors.lists[block];
                    self.each_pair(
                        list,
                        moves[block],
                        moves,
                        force.len(),
                        |weight, at, dx, dy| {
                            let along = weight * force[at as usize] / at.max(1e-6);
                            slope[0] += along * dx;
                            slope[1] += along * dy;
                        },
                    );
                    let part = self.share * masses[block] / mean[block];
                    // Distances are in mean spacings of this pattern, moves in those of the table.
                    let part = part * BINS_PER_SPACING * self.stretch * self.stretch;
                    out[0] += part * slope[0];
                    out[1] += part * slope[1];
                }
            });
    }

    /// Calls `visit` for each pair in the list of a point with its weight, its distance in bins,
    /// and the vector from the neighbor to the point. Distances beyond the last bin are clamped to
    /// it, where the taper is 0.
    #[inline]
    fn each_pair(
        &self,
        list: &[Pair],
        own: [f64; 2],
        moves: &[[f64; 2]],
        bins: usize,
        mut visit: impl FnMut(f64, f64, f64, f64),
    ) {
        let scale = self.neighbors.scale;
        let (per_spacing, last) = (BINS_PER_SPACING * self.stretch, (bins - 1) as f64);
        let apart = |pair: &Pair| {
            let to = moves[pair.to as usize];
            let dx = own[0] - (scale * f64::from(pair.i) + to[0]);
            let dy = own[1] - (scale * f64::from(pair.j) + to[1]);
            [dx, dy]
        };
        let distance = |[dx, dy]: [f64; 2]| ((dx * dx + dy * dy).sqrt() * per_spacing).min(last);
        // In groups, so that the compiler can vectorize.
        let (groups, rest) = list.as_chunks::<LANES>();
        for group in groups {
            let apart = group.each_ref().map(apart);
            let at = apart.map(distance);
            for ((pair, at), [dx, dy]) in group.iter().zip(at).zip(apart) {
                visit(f64::from(pair.weight), at, dx, dy);
            }
        }
        for pair in rest {
            let [dx, dy] = apart(pair);
            visit(f64::from(pair.weight), distance([dx, dy]), dx, dy);
        }
    }
}

impl Objective for Radial {
    fn masses(&self) -> &[f64] {
        &self.masses
    }

    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        gradient.fill([0.0; 2]);
        let mut cost = 0.0;
        for pattern in &mut self.patterns {
            pattern.neighbors.refresh(moves);
            let power = self.rings.power(&pattern.histogram(&self.rings, moves));
            cost += pattern.share * self.rings.cost(&power);
            let force = self.rings.force(&power);
            pattern.add_slope(&force, moves, &self.masses, gradient);
        }
        cost + self.pull(moves, gradient)
    }

    /// The lists of all patterns are built for the same moves.
    fn prepared_for(&self) -> &[[f64; 2]] {
        &self.patterns[0].neighbors.built_for
    }

    fn prepare_for(&mut self, moves: &[[f64; 2]]) {
        for pattern in &mut self.patterns {
            pattern.neighbors.build(moves);
        }
    }

    fn pairs(&self) -> usize {
        let lists = self
            .patterns
            .iter()
            .flat_map(|pattern| &pattern.neighbors.lists);
        lists.map(Vec::len).sum()
    }
}

#[cfg(test)]
mod tests {
    use strew_core::{Alpha, Map, Table, Twin, table::Provenance, table::from_grid_units};

    use super::*;
    use crate::{
        measure::{Spectrum, twin_set},
        optimize::{check_slopes, jitter},
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
        Radial::new(&[(map.clone(), 1.0)], &step(), &WEIGHTS)
    }

    #[test]
    fn its_gradient_is_that_of_its_energy() {
        let map = map();
        let far = Alpha::from_fraction(265 + 419, 419).expect("in range");
        let far = Map::new(far, map.radius()).expect("small");
        let blocks = map.intervals() * map.intervals();
        assert_eq!(far.intervals(), map.intervals());
        for maps in [vec![(map.clone(), 1.0)], vec![(map, 0.6), (far, 0.4)]] {
            let mut radial = Radial::new(&maps, &step(), &WEIGHTS);
            check_slopes(&mut radial, &jitter(blocks, 0.8, 3), &[7, 200, 431]);
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
        let rings = Spectrum::of(&set, 2.1).rings(0.1);
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
}
