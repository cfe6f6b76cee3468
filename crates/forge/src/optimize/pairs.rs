//! Neighbor lists and pair energies in table space: which blocks are near each other, at which offsets, and how often.
//!
//! A pair energy of a displaced pattern is a sum of frequency × energy over pairs of blocks and lattice offsets. The lists hold
//! these pairs with their frequencies, of one pattern or merged over several. So optimizing over a twin of a million points
//! costs what the smallest twin costs: about 150 pairs a block for a Gaussian of σ = 1. Every pair of blocks that occurs in any
//! of the patterns is visited in every step, with its weight. That keeps pairs that seldom meet from collapsing unseen.

use rayon::prelude::*;
use strew_core::Map;

use super::{
    Objective,
    ground::{Ground, Meet, Pair},
};
use crate::energy::PairEnergy;

/// Lists have whole groups of this many pairs, so that the compiler can vectorize sums over them.
/// The number also fixes the order of summation, so tables depend on it.
pub(crate) const LANES: usize = 8;
/// Blocks per parallel task. It fixes an order of summation, too.
pub(crate) const CHUNK: usize = 64;
/// Lists reach this far beyond the cut-off, in mean spacings, and stay valid until some block has
/// moved by half of it.
const SKIN: f64 = 0.7;
/// Displacements up to half of this, in mean spacings, find all their neighbors.
const MAX_APPROACH: f64 = 8.0;

/// The length of the longest move.
pub(crate) fn longest(moves: &[[f64; 2]]) -> f64 {
    let squared = moves.iter().map(|m| m[0] * m[0] + m[1] * m[1]);
    squared.fold(0.0, f64::max).sqrt()
}

/// Fills the last group of [`LANES`] with pairs of weight 0.
pub(crate) fn fill(list: &mut Vec<Pair>) {
    let weightless = Pair {
        to: 0,
        i: 0,
        j: 0,
        weight: 0.0,
    };
    list.resize(list.len().next_multiple_of(LANES), weightless);
}

/// The energy and the gradient of one instance of a block at the move `own`, lane by lane, over its list. `pair` is
/// the [`PairEnergy`](crate::energy::PairEnergy) of a squared distance in mean spacings, of which `scale` make a
/// grid unit.
#[inline]
pub(crate) fn sum(
    list: &[Pair],
    scale: f64,
    moves: &[[f64; 2]],
    own: [f64; 2],
    pair: impl Fn(f64) -> (f64, f64),
) -> (f64, [f64; 2]) {
    let (mut energy, mut gx, mut gy) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    for group in list.chunks_exact(LANES) {
        let (mut dx, mut dy, mut weight) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for (lane, pair) in group.iter().enumerate() {
            let to = moves[pair.to as usize];
            dx[lane] = own[0] - (scale * f64::from(pair.i) + to[0]);
            dy[lane] = own[1] - (scale * f64::from(pair.j) + to[1]);
            weight[lane] = f64::from(pair.weight);
        }
        for lane in 0..LANES {
            let (value, slope) = pair(dx[lane] * dx[lane] + dy[lane] * dy[lane]);
            energy[lane] += weight[lane] * value;
            gx[lane] += weight[lane] * slope * dx[lane];
            gy[lane] += weight[lane] * slope * dy[lane];
        }
    }
    let total = |lanes: [f64; LANES]| lanes.iter().sum::<f64>();
    (total(energy), [total(gx), total(gy)])
}

/// Identifies a pair in the list of its block, and sorts the list: (j, i, to).
type Key = (i16, i16, u32);

/// The pairs of all blocks up to a cut-off, valid near the moves they were built for.
pub(super) struct Neighbors {
    /// In mean spacings.
    cutoff: f64,
    /// One for each pattern.
    patterns: Vec<Ground>,
    /// Mean spacings per grid unit.
    pub(super) scale: f64,
    /// The share of points that each block has.
    pub(super) masses: Vec<f64>,
    /// The moves that the lists were built for; empty before that.
    pub(super) built_for: Vec<[f64; 2]>,
    /// The pairs of each block, valid for the moves of the last [`refresh`](Self::refresh).
    pub(super) lists: Vec<Vec<Pair>>,
}

impl Neighbors {
    /// Empty lists for the patterns of `maps`, which are one map for slightly different α. `scale`
    /// is the number of mean spacings per grid unit. Weights are means over the patterns.
    pub(super) fn new(cutoff: f64, maps: &[Map], scale: f64) -> Self {
        let reach = cutoff + SKIN + MAX_APPROACH;
        let ground = |map: &Map| Ground::scaled(map, reach, scale);
        let patterns: Vec<Ground> = maps.iter().map(ground).collect();
        let mut masses: Vec<f64> = (0..patterns[0].shares.len())
            .map(|block| area(&patterns, block))
            .collect();
        let total: f64 = masses.iter().sum();
        masses.iter_mut().for_each(|m| *m /= total);
        Self {
            cutoff,
            patterns,
            scale,
            masses,
            built_for: Vec::new(),
            lists: Vec::new(),
        }
    }

    /// Builds the lists again if they are not valid for these moves.
    pub(super) fn refresh(&mut self, moves: &[[f64; 2]]) {
        if self.is_stale(moves) {
            self.build(moves);
        }
    }

    fn is_stale(&self, moves: &[[f64; 2]]) -> bool {
        let limit = SKIN * SKIN / 4.0;
        self.built_for.len() != moves.len()
            || moves.iter().zip(&self.built_for).any(|(a, b)| {
                let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
                dx * dx + dy * dy > limit
            })
    }

    /// Builds the lists for these moves.
    pub(super) fn build(&mut self, moves: &[[f64; 2]]) {
        let moved = (moves, longest(moves));
        let blocks = (0..moves.len()).into_par_iter();
        let lists = blocks.map(|block| self.pairs_of(block, moved));
        self.lists = lists.collect();
        self.built_for = moves.to_vec();
    }

    /// The pairs of one block, merged over the patterns and sorted by key, given all moves and the length of the longest.
    fn pairs_of(&self, block: usize, moved: (&[[f64; 2]], f64)) -> Vec<Pair> {
        let mut found: Vec<(Key, f64)> = Vec::new();
        for ground in &self.patterns {
            let add = |meet: Meet, _| found.push(((meet.j, meet.i, meet.to), meet.area));
            ground.near(block, moved, self.cutoff + SKIN, |_| true, add);
        }
        merge(found, area(&self.patterns, block))
    }
}

/// One pair for each key, whose weight is the sum of its areas over that of the block.
fn merge(mut found: Vec<(Key, f64)>, area: f64) -> Vec<Pair> {
    found.sort_by_key(|&(key, _)| key);
    let mut pairs: Vec<Pair> = Vec::with_capacity(found.len() / 2);
    let mut sum = 0.0;
    for (at, &(key, part)) in found.iter().enumerate() {
        sum += part;
        if found.get(at + 1).is_none_or(|next| next.0 != key) {
            let (j, i, to) = key;
            let weight = (sum / area) as f32;
            pairs.push(Pair { to, i, j, weight });
            sum = 0.0;
        }
    }
    fill(&mut pairs);
    pairs
}

/// The area of a block in index space, summed over the patterns.
fn area(patterns: &[Ground], block: usize) -> f64 {
    patterns.iter().map(|ground| ground.area(block)).sum()
}

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
