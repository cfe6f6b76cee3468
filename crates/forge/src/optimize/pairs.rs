//! Pair energies in table space, exactly: no point set, only frequencies.
//!
//! A pair energy of a displaced pattern is a sum over pairs of blocks and lattice offsets of
//! frequency × energy, and the frequencies are products of interval overlaps (see
//! [`overlap`](super::overlap)). Taking them of a fraction gives, to the last pair, the energy of
//! its periodic twin *of any size*, at a cost that depends on the table alone: about 150 pairs a
//! block. So optimizing over a twin of a million points costs what the smallest one costs, and
//! over several twins at once hardly more, because they share nearly all pairs of blocks. That is
//! what keeps pairs that seldom meet from hiding: every pair that occurs in any of the twins is
//! seen in every step, with its weight.

use rayon::prelude::*;
use strew_core::Map;

use super::{Objective, overlap::Overlaps};
use crate::energy::PairEnergy;

/// Pairs are evaluated in groups of this many, so that the compiler can vectorize; it also fixes
/// the order of summation.
pub(super) const LANES: usize = 8;
/// Blocks per parallel task. It fixes the order of summation too, so it is part of the result.
pub(super) const CHUNK: usize = 64;
/// A list of pairs holds those up to cut-off + this, in mean spacings, and stays valid until some
/// block has moved by half of it.
const SKIN: f64 = 0.7;

/// A neighbor of a block: at lattice offset (i, j) stands an instance of block `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    pub(super) to: u32,
    pub(super) i: i16,
    pub(super) j: i16,
    /// How many such neighbors an instance of the block has on average.
    pub(super) weight: f32,
}

/// What tells pairs of one block apart: (j, i, to).
type Key = (i16, i16, u32);

/// A pair energy as a function of a table's vectors, averaged over one or several patterns with
/// the same map.
pub struct Pairs<E> {
    energy: E,
    intervals: usize,
    /// One for each pattern.
    patterns: Vec<Overlaps>,
    /// Mean spacings per grid unit.
    scale: f64,
    masses: Vec<f64>,
    lists: Lists,
}

/// Neighbor lists of all blocks, valid near the moves they were built for.
#[derive(Default)]
struct Lists {
    built_for: Vec<[f64; 2]>,
    /// Where each block's pairs start; whole groups of [`LANES`].
    starts: Vec<usize>,
    pairs: Vec<Pair>,
}

impl<E: PairEnergy> Pairs<E> {
    /// The energy averaged over the patterns of `maps`, which are one map for slightly different
    /// α: its own, or the fractions of its twins. `scale` is the side t of the set region as a part
    /// of the torus, so that moves and distances are in mean spacings.
    #[must_use]
    pub fn new(energy: E, maps: &[Map], scale: f64) -> Self {
        let intervals = maps[0].intervals();
        // Displacements of up to 4 mean spacings find all their neighbors.
        let reach = ((energy.cutoff() + SKIN + 8.0) / scale).ceil() as i64;
        let patterns: Vec<Overlaps> = maps.iter().map(|map| Overlaps::new(map, reach)).collect();
        let mut masses: Vec<f64> = (0..intervals * intervals)
            .map(|block| area(&patterns, block, intervals))
            .collect();
        let total: f64 = masses.iter().sum();
        masses.iter_mut().for_each(|m| *m /= total);
        Self {
            energy,
            intervals,
            patterns,
            scale,
            masses,
            lists: Lists::default(),
        }
    }

    /// Makes the lists valid for these moves.
    pub(super) fn refresh(&mut self, moves: &[[f64; 2]]) {
        if self.lists_are_stale(moves) {
            self.build_lists(moves);
        }
    }

    /// The pairs of a block, valid for the moves of the last [`refresh`](Self::refresh).
    pub(super) fn list(&self, block: usize) -> &[Pair] {
        &self.lists.pairs[self.lists.starts[block]..self.lists.starts[block + 1]]
    }

    /// Mean spacings per grid unit.
    pub(super) const fn scale(&self) -> f64 {
        self.scale
    }

    fn lists_are_stale(&self, moves: &[[f64; 2]]) -> bool {
        let limit = SKIN * SKIN / 4.0;
        self.lists.built_for.len() != moves.len()
            || moves.iter().zip(&self.lists.built_for).any(|(a, b)| {
                let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
                dx * dx + dy * dy > limit
            })
    }

    fn build_lists(&mut self, moves: &[[f64; 2]]) {
        let longest = moves
            .iter()
            .map(|m| m[0] * m[0] + m[1] * m[1])
            .fold(0.0, f64::max)
            .sqrt();
        let range = self.energy.cutoff() + SKIN;
        let of_block: Vec<Vec<Pair>> = (0..moves.len())
            .into_par_iter()
            .map(|block| self.pairs_of(block, moves, range, longest))
            .collect();
        self.lists = Lists {
            built_for: moves.to_vec(),
            starts: vec![0],
            pairs: Vec::with_capacity(of_block.iter().map(Vec::len).sum()),
        };
        for list in of_block {
            self.lists.pairs.extend(list);
            self.lists.starts.push(self.lists.pairs.len());
        }
    }

    /// The pairs of one block within `range`, merged over the patterns, in the order of their key,
    /// filled up to whole groups by pairs without weight.
    fn pairs_of(&self, block: usize, moves: &[[f64; 2]], range: f64, longest: f64) -> Vec<Pair> {
        let (n, scale) = (self.intervals, self.scale);
        let (bx, by) = (block % n, block / n);
        let own = moves[block];
        let lattice_range = (range + 2.0 * longest) / scale;
        let reach = (lattice_range as i64).min(self.patterns[0].reach());
        let mut found: Vec<(Key, f64)> = Vec::new();
        for overlaps in &self.patterns {
            for j in -reach..=reach {
                for i_parity in 0..2 {
                    let rows = overlaps.of(j, i_parity, by);
                    if rows.is_empty() {
                        continue;
                    }
                    let first = -reach + ((reach + i_parity) & 1);
                    for i in (first..=reach).step_by(2) {
                        if (i, j) == (0, 0) {
                            continue;
                        }
                        for column in overlaps.of(i, j, bx) {
                            for row in rows {
                                let to = row.to as usize * n + column.to as usize;
                                let dx = scale * i as f64 + moves[to][0] - own[0];
                                let dy = scale * j as f64 + moves[to][1] - own[1];
                                if dx * dx + dy * dy < range * range {
                                    let key = (j as i16, i as i16, to as u32);
                                    found.push((key, column.length * row.length));
                                }
                            }
                        }
                    }
                }
            }
        }
        merge(found, area(&self.patterns, block, n))
    }
}

/// Sums the areas of equal keys, in the order found, and makes them weights.
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
    let filler = Pair {
        to: 0,
        i: 0,
        j: 0,
        weight: 0.0,
    };
    pairs.resize(pairs.len().next_multiple_of(LANES), filler);
    pairs
}

/// The area of a block, summed over the patterns.
fn area(patterns: &[Overlaps], block: usize, intervals: usize) -> f64 {
    let (bx, by) = (block % intervals, block / intervals);
    patterns.iter().map(|p| p.length(bx) * p.length(by)).sum()
}

impl<E: PairEnergy> Objective for Pairs<E> {
    fn masses(&self) -> &[f64] {
        &self.masses
    }

    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        self.refresh(moves);
        let masses = &self.masses;
        let partial: Vec<f64> = gradient
            .par_chunks_mut(CHUNK)
            .enumerate()
            .map(|(chunk, gradient)| {
                let mut energy = 0.0;
                for (at, out) in gradient.iter_mut().enumerate() {
                    let block = chunk * CHUNK + at;
                    let (value, slope) = self.sum(self.list(block), moves, moves[block]);
                    *out = slope;
                    energy += masses[block] * value;
                }
                energy
            })
            .collect();
        // Every pair was met from both ends.
        0.5 * partial.iter().sum::<f64>()
    }

    fn prepared_for(&self) -> &[[f64; 2]] {
        &self.lists.built_for
    }

    fn prepare_for(&mut self, moves: &[[f64; 2]]) {
        self.build_lists(moves);
    }

    fn pairs(&self) -> usize {
        self.lists.pairs.len()
    }
}

impl<E: PairEnergy> Pairs<E> {
    /// Energy and gradient of one instance of a block, lane by lane.
    fn sum(&self, list: &[Pair], moves: &[[f64; 2]], own: [f64; 2]) -> (f64, [f64; 2]) {
        let (mut energy, mut gx, mut gy) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for group in list.chunks_exact(LANES) {
            let (mut dx, mut dy, mut weight) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for (lane, pair) in group.iter().enumerate() {
                let to = moves[pair.to as usize];
                dx[lane] = own[0] - (self.scale * f64::from(pair.i) + to[0]);
                dy[lane] = own[1] - (self.scale * f64::from(pair.j) + to[1]);
                weight[lane] = f64::from(pair.weight);
            }
            for lane in 0..LANES {
                let (value, slope) = self.energy.pair(dx[lane] * dx[lane] + dy[lane] * dy[lane]);
                energy[lane] += weight[lane] * value;
                gx[lane] += weight[lane] * slope * dx[lane];
                gy[lane] += weight[lane] * slope * dy[lane];
            }
        }
        let total = |lanes: [f64; LANES]| lanes.iter().sum::<f64>();
        (total(energy), [total(gx), total(gy)])
    }
}

#[cfg(test)]
mod tests {
    use strew_core::{Alpha, Twin};

    use super::*;
    use crate::{
        energy::{Gaussian, Guard, Pairwise, SetEnergy},
        measure::Torus,
        optimize::jitter,
    };

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

    /// The definition: displaced sites, all pairs, the mean over each block's instances.
    fn on_points(map: &Map, twin: Twin, moves: &[[f64; 2]]) -> (f64, Vec<[f64; 2]>) {
        let n = map.intervals();
        let sites = twin.sites(map).expect("a twin");
        let block = |s: &strew_core::map::Site| s.block_y as usize * n + s.block_x as usize;
        let scale = twin.t() as f64 / twin.period() as f64;
        let points = sites
            .iter()
            .map(|s| {
                let by = moves[block(s)];
                [
                    f64::from(s.x) * scale + by[0],
                    f64::from(s.y) * scale + by[1],
                ]
            })
            .collect();
        let set = Torus::new(twin.t() as f64, points);
        let mut each = vec![[0.0; 2]; sites.len()];
        let value = Pairwise(energy()).evaluate(&set, &mut each);
        let mut mean = vec![[0.0; 3]; moves.len()];
        for (site, slope) in sites.iter().zip(&each) {
            let sum = &mut mean[block(site)];
            *sum = [sum[0] + slope[0], sum[1] + slope[1], sum[2] + 1.0];
        }
        (
            value,
            mean.iter().map(|m| [m[0] / m[2], m[1] / m[2]]).collect(),
        )
    }

    #[test]
    fn frequencies_give_the_energy_and_the_gradient_of_the_points() {
        let map = map(9);
        let n = map.intervals();
        for twin in uniform_twins(&map, 3) {
            let scale = twin.t() as f64 / twin.period() as f64;
            let mut pairs = Pairs::new(energy(), &[twin_map(&map, twin)], scale);
            for (spread, seed) in [(0.1, 1), (0.9, 2), (0.95, 2)] {
                let moves = jitter(n * n, spread, seed);
                let mut gradient = vec![[0.0; 2]; n * n];
                let value = pairs.evaluate(&moves, &mut gradient);
                let (expected, slopes) = on_points(&map, twin, &moves);
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
        let maps: Vec<Map> = uniform_twins(&map, 3)
            .iter()
            .map(|&t| twin_map(&map, t))
            .collect();
        let moves = jitter(n * n, 0.4, 5);
        let mut gradient = vec![[0.0; 2]; n * n];
        let mut value =
            |maps: &[Map]| Pairs::new(energy(), maps, scale).evaluate(&moves, &mut gradient);
        let areas: Vec<f64> = maps
            .iter()
            .map(|m| m.alpha().set_side_f64().powi(2))
            .collect();
        let each: f64 = maps
            .iter()
            .zip(&areas)
            .map(|(m, area)| value(std::slice::from_ref(m)) * area)
            .sum();
        let mean = each / areas.iter().sum::<f64>();
        assert!((value(&maps) - mean).abs() < 1e-6 * mean);
    }

    #[test]
    fn lists_stay_valid_while_blocks_move() {
        let map = map(9);
        let n = map.intervals();
        let make = || {
            Pairs::new(
                energy(),
                std::slice::from_ref(&map),
                map.alpha().set_side_f64(),
            )
        };
        let mut used = make();
        let mut gradient = vec![[0.0; 2]; n * n];
        for step in 0..8 {
            let moves: Vec<[f64; 2]> = jitter(n * n, 1.0, 4)
                .iter()
                .map(|m| m.map(|v| v * f64::from(step) / 7.0))
                .collect();
            let value = used.evaluate(&moves, &mut gradient);
            let fresh = make().evaluate(&moves, &mut gradient);
            assert!((value - fresh).abs() < 1e-12, "{step}: {value} {fresh}");
        }
    }
}
