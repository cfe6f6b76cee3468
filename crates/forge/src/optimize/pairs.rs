//! Pair energies in table space: sums over pairs of blocks, weighted by exact frequencies.
//!
//! A pair energy of a displaced pattern is a sum of frequency × energy over pairs of blocks and
//! lattice offsets. [Neighbor lists](super::neighbors) hold these pairs with their frequencies, of
//! one pattern or merged over several. So optimizing over a twin of a million points costs what the
//! smallest twin costs, and every pair of blocks that occurs in any of the patterns is visited in
//! every step, with its weight. That keeps pairs that seldom meet from collapsing unseen.

use rayon::prelude::*;
use strew_core::Map;

use super::{
    Objective,
    neighbors::{CHUNK, Neighbors, sum},
};
use crate::energy::PairEnergy;

/// A pair energy as a function of a table's vectors, averaged over one or several patterns with
/// the same map.
pub struct Pairs<E> {
    energy: E,
    neighbors: Neighbors,
}

impl<E: PairEnergy> Pairs<E> {
    /// The energy averaged over the patterns of `maps`, which are one map for slightly different
    /// α: its own, or the fractions of its twins. `scale` is the side t of the set region as a part
    /// of the torus, which is the number of mean spacings per grid unit.
    #[must_use]
    pub fn new(energy: E, maps: &[Map], scale: f64) -> Self {
        let neighbors = Neighbors::new(energy.cutoff(), maps, scale);
        Self { energy, neighbors }
    }
}

impl<E: PairEnergy> Objective for Pairs<E> {
    fn masses(&self) -> &[f64] {
        &self.neighbors.masses
    }

    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        self.neighbors.refresh(moves);
        let masses = &self.neighbors.masses;
        let partial: Vec<f64> = gradient
            .par_chunks_mut(CHUNK)
            .enumerate()
            .map(|(chunk, gradient)| {
                let mut energy = 0.0;
                for (at, out) in gradient.iter_mut().enumerate() {
                    let block = chunk * CHUNK + at;
                    let (list, scale) = (&self.neighbors.lists[block], self.neighbors.scale);
                    let pair = |squared| self.energy.pair(squared);
                    let (value, slope) = sum(list, scale, moves, moves[block], pair);
                    *out = slope;
                    energy += masses[block] * value;
                }
                energy
            })
            .collect();
        // Every pair was visited from both ends.
        0.5 * partial.iter().sum::<f64>()
    }

    fn prepared_for(&self) -> &[[f64; 2]] {
        &self.neighbors.built_for
    }

    fn prepare_for(&mut self, moves: &[[f64; 2]]) {
        self.neighbors.build(moves);
    }

    fn pairs(&self) -> usize {
        self.neighbors.lists.iter().map(Vec::len).sum()
    }
}

#[cfg(test)]
mod tests {
    use strew_core::{Alpha, Twin};

    use super::*;
    use crate::{
        energy::{Gaussian, Guard, SetEnergy},
        measure::Sample,
        optimize::{Sets, jitter},
    };

    /// The energy of a set by the definition, over all pairs of its points, each at its nearest image.
    struct AllPairs;

    impl SetEnergy for AllPairs {
        fn evaluate(&self, set: &Sample, gradient: &mut [[f64; 2]]) -> f64 {
            let (points, side, mut total) = (set.points(), set.side(), 0.0);
            for (i, (p, slope)) in points.iter().zip(gradient).enumerate() {
                *slope = [0.0; 2];
                for q in points[..i].iter().chain(&points[i + 1..]) {
                    let by = [p[0] - q[0], p[1] - q[1]].map(|v| v - (v / side).round() * side);
                    let (value, factor) = energy().pair(by[0] * by[0] + by[1] * by[1]);
                    total += value;
                    *slope = [slope[0] + factor * by[0], slope[1] + factor * by[1]];
                }
            }
            0.5 * total / points.len() as f64
        }
    }

    fn map(radius: u32) -> Map {
        Map::new("(5-sqrt(3))/2".parse().expect("valid"), radius).expect("small")
    }

    fn twin_map(map: &Map, twin: Twin) -> Map {
        let alpha = Alpha::from_fraction(twin.p(), twin.q()).expect("in range");
        Map::new(alpha, map.radius()).expect("small")
    }

    fn uniform_twins(map: &Map, count: usize) -> Vec<Twin> {
        let uniform = map.twins().filter(|t| t.is_uniform() && t.points() > 600);
        uniform.take(count).collect()
    }

    fn energy() -> (Gaussian, Guard) {
        (Gaussian::new(1.0), Guard::new(0.8, 0.3))
    }

    #[test]
    fn frequencies_give_the_energy_and_the_gradient_of_the_points() {
        let map = map(9);
        let n = map.intervals();
        for twin in uniform_twins(&map, 3) {
            let scale = twin.t() as f64 / twin.period() as f64;
            let mut pairs = Pairs::new(energy(), &[twin_map(&map, twin)], scale);
            // Displaced sites, and the mean over each block's instances.
            let mut sets = Sets::new(AllPairs, &map, &[twin]);
            assert!((sets.masses().iter().sum::<f64>() - 1.0).abs() < 1e-12);
            for (spread, seed) in [(0.1, 1), (0.9, 2), (0.95, 2)] {
                let moves = jitter(n * n, spread, seed);
                let [mut gradient, mut slopes] = [(); 2].map(|()| vec![[0.0; 2]; n * n]);
                let value = pairs.evaluate(&moves, &mut gradient);
                let expected = sets.evaluate(&moves, &mut slopes);
                assert!(
                    (value - expected).abs() < 1e-6 * expected,
                    "{twin}: {value} {expected}"
                );
                for (found, slope) in gradient.iter().zip(&slopes) {
                    let error = (found[0] - slope[0]).hypot(found[1] - slope[1]);
                    assert!(error < 1e-5, "{twin}: {found:?} {slope:?}");
                }
            }
        }
    }

    #[test]
    fn several_patterns_are_averaged() {
        let map = map(9);
        let n = map.intervals();
        let scale = map.alpha().set_side_f64();
        let twins = uniform_twins(&map, 3).into_iter();
        let maps: Vec<Map> = twins.map(|twin| twin_map(&map, twin)).collect();
        let moves = jitter(n * n, 0.4, 5);
        let mut gradient = vec![[0.0; 2]; n * n];
        let mut value =
            |maps: &[Map]| Pairs::new(energy(), maps, scale).evaluate(&moves, &mut gradient);
        let areas = maps.iter().map(|map| map.alpha().set_side_f64().powi(2));
        let areas: Vec<f64> = areas.collect();
        let each = maps.iter().zip(&areas);
        let each = each.map(|(map, area)| value(std::slice::from_ref(map)) * area);
        let each: f64 = each.sum();
        let mean = each / areas.iter().sum::<f64>();
        assert!((value(&maps) - mean).abs() < 1e-6 * mean);
    }

    #[test]
    fn lists_stay_valid_while_blocks_move() {
        let map = map(9);
        let n = map.intervals();
        let (maps, scale) = (std::slice::from_ref(&map), map.alpha().set_side_f64());
        let make = || Pairs::new(energy(), maps, scale);
        let mut used = make();
        let mut gradient = vec![[0.0; 2]; n * n];
        for step in 0..8 {
            let mut moves = jitter(n * n, 1.0, 4);
            for v in moves.as_flattened_mut() {
                *v *= f64::from(step) / 7.0;
            }
            let value = used.evaluate(&moves, &mut gradient);
            let fresh = make().evaluate(&moves, &mut gradient);
            assert!((value - fresh).abs() < 1e-12, "{step}: {value} {fresh}");
        }
    }
}
