//! Neighbor lists in table space: which blocks are near each other, at which offsets, and how often.
//!
//! They cost what depends on the table alone: about 150 pairs a block for a Gaussian of σ = 1. Lists for several twins at
//! once are hardly longer, because twins share nearly all pairs of blocks.

use rayon::prelude::*;
use strew_core::Map;

use super::ground::{Ground, Meet, Pair};

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
