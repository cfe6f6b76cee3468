//! Void and cluster (Ulichney 1993) over blocks instead of points: again and again the block of the highest potential
//! leaves. Blocks may be of several kinds, whose shares of what is left stay what they are.
//!
//! The ranks of a table are that order for one kind: potentials are Gaussian sums over what is left, with exact frequencies and
//! the table's own vectors, σ is 0.6 of the mean spacing that is left, and no point moves.

use rayon::prelude::*;
use strew_core::{Table, table::Ranks};

use crate::{
    ForgeError,
    numeric::exp,
    optimize::{Ground, longest, moves_of},
};

/// The potentials of blocks, and how they change as blocks leave.
pub(crate) trait Surroundings {
    /// The share of all points that a block has.
    fn share(&self, block: usize) -> f64;

    /// The potential of each block that is left. It serves until of the share `left` of all points only `target` is left.
    /// `None` ends the work.
    fn potentials(&mut self, is_left: &[bool], left: f64, target: f64) -> Option<Vec<f64>>;

    /// Calls `lose` for the blocks whose potentials fall when a block leaves, with how far.
    fn leave(&self, block: usize, lose: impl FnMut(usize, f64));
}

/// The tolerated fall of a kind's share among the points that are left: absolute, and relative to its share.
const SLACK: [f64; 2] = [0.002, 0.03];

/// The order in which blocks leave, as the position of each: 0 for the one that leaves last. `labels` has the kind of each
/// block, `shares` the part of the points that each kind has. Potentials are computed anew each time the share that is left
/// has fallen by the factor `kept`; the last `fewest` blocks follow by number.
pub(crate) fn positions(
    around: &mut impl Surroundings,
    labels: &[u8],
    shares: &[f64],
    kept: f64,
    fewest: usize,
) -> Option<Vec<u32>> {
    let kind_of = |block: usize| usize::from(labels[block]);
    let blocks = 0..labels.len();
    let mut is_left = vec![true; labels.len()];
    let mut positions = vec![0; labels.len()];
    let mut areas = vec![0.0; shares.len()];
    for block in blocks.clone() {
        areas[kind_of(block)] += around.share(block);
    }
    let (mut left, mut number) = (1.0, labels.len());
    while number > fewest {
        let target = left * kept;
        let mut potential = around.potentials(&is_left, left, target)?;
        let of_kind = |kind: usize| {
            let is_own = |block: usize| is_left[block] && kind_of(block) == kind;
            let own = |block| is_own(block).then_some(potential[block]);
            Fullest::new(blocks.clone().map(|block| own(block).unwrap_or(NONE)))
        };
        let mut fullest: Vec<Fullest> = (0..shares.len()).map(of_kind).collect();
        while let Some(block) = leaving(&fullest, shares, &areas, left) {
            let (kind, share) = (kind_of(block), around.share(block));
            is_left[block] = false;
            fullest[kind].set(block, NONE);
            areas[kind] -= share;
            left -= share;
            number -= 1;
            positions[block] = number as u32;
            around.leave(block, |to, by| {
                potential[to] -= by;
                if is_left[to] {
                    fullest[kind_of(to)].set(to, potential[to]);
                }
            });
            if left <= target || number <= fewest {
                break;
            }
        }
    }
    let rest = blocks.rev().filter(|&block| is_left[block]);
    for (position, block) in (0..).zip(rest) {
        positions[block] = position;
    }
    Some(positions)
}

/// The block of the highest potential among the kinds that may lose one. A kind that has fallen behind its share of what is
/// left waits.
fn leaving(fullest: &[Fullest], shares: &[f64], areas: &[f64], left: f64) -> Option<usize> {
    let kinds = fullest.iter().zip(shares).zip(areas);
    let kinds = kinds.filter_map(|((fullest, share), area)| {
        let excess = (area / left - share) / SLACK[0].min(SLACK[1] * share);
        Some((excess, fullest.highest()?))
    });
    let most = kinds.clone().map(|kind| kind.0).fold(NONE, f64::max);
    let may_lose = kinds.filter(|kind| kind.0 >= most.min(-1.0));
    // The first of equal ones.
    let highest = may_lose
        .map(|kind| kind.1)
        .reduce(|best, next| if next.0 > best.0 { next } else { best });
    highest.map(|(_, block)| block)
}

/// The potential of a block that does not count.
const NONE: f64 = f64::NEG_INFINITY;

/// The highest of the potentials of blocks, kept up to date while they change, by a tree of pairs: a node has the block of
/// the higher potential below it, of equal ones the first. So it finds what a look at all would, in the time of a few
/// comparisons for each change.
struct Fullest {
    values: Vec<f64>,
    /// Node 1 is the root; the children of node i are 2i and 2i + 1, the leaves the blocks.
    nodes: Vec<u32>,
}

impl Fullest {
    fn new(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.resize(values.len().max(1).next_power_of_two(), NONE);
        let leaves = values.len() as u32;
        let mut all = Self {
            nodes: (0..leaves).chain(0..leaves).collect(),
            values,
        };
        (1..leaves as usize).rev().for_each(|node| all.renew(node));
        all
    }

    fn renew(&mut self, node: usize) {
        let [a, b] = [self.nodes[2 * node], self.nodes[2 * node + 1]];
        let is_second = self.values[b as usize] > self.values[a as usize];
        self.nodes[node] = if is_second { b } else { a };
    }

    fn set(&mut self, block: usize, value: f64) {
        self.values[block] = value;
        let mut node = (self.values.len() + block) / 2;
        while node > 0 {
            self.renew(node);
            node /= 2;
        }
    }

    /// The highest potential and its block.
    fn highest(&self) -> Option<(f64, usize)> {
        let block = self.nodes[1] as usize;
        let value = self.values[block];
        (value > NONE).then_some((value, block))
    }
}

/// σ in mean spacings of the thinned set. At 0.7 low power is about equal and pairs are nearer, at 0.9 low
/// power is a third higher.
const SIGMA: f64 = 0.6;
/// The cut-off of the Gaussian, in σ.
const CUTOFF: f64 = 4.5;
/// Blocks nearer than this, in mean spacings of the thinned set, press each other, even those that seldom
/// meet: a single pair decides the least distance.
const GUARD: f64 = 0.5;
/// The strength of that press.
const PRESSURE: f64 = 1.0;
/// The share of the points left after which neighbor lists are made again.
const BATCH: f64 = 0.03;
/// The fewest blocks among which the potential still decides.
const FEWEST: usize = 4;

/// The share at which lists no longer grow: below it neighbors lie farther apart than lists reach.
const LEAST: f64 = 1.0 / 4096.0;

/// Adds to a table the order in which its blocks leave when a set is thinned.
///
/// Equal tables get equal orders on every machine. It takes a second for 63 intervals and 20 for 255.
pub fn with_ranks(table: &Table) -> Result<Table, ForgeError> {
    let moves = moves_of(table);
    let longest = longest(&moves);
    let reach = CUTOFF * SIGMA / LEAST.sqrt() + 2.0 * longest;
    let ground = Ground::new(table.map(), reach);
    let mut left = Left {
        ground: &ground,
        moves: &moves,
        longest,
        lists: Vec::new(),
    };
    let labels = vec![0; ground.shares.len()];
    let found = positions(&mut left, &labels, &[1.0], 1.0 - BATCH, FEWEST);
    Ok(table.with_ranks(Ranks::new(found.unwrap_or_default())?)?)
}

/// The blocks of a table that are left, and which of them influence each other.
struct Left<'a> {
    ground: &'a Ground,
    moves: &'a [[f64; 2]],
    /// The length of the longest move.
    longest: f64,
    lists: Vec<Vec<Felt>>,
}

impl Surroundings for Left<'_> {
    fn share(&self, block: usize) -> f64 {
        self.ground.shares[block]
    }

    fn potentials(&mut self, is_left: &[bool], _: f64, target: f64) -> Option<Vec<f64>> {
        let spacing = 1.0 / target.max(LEAST).sqrt();
        let rate = -0.5 / (SIGMA * spacing * SIGMA * spacing);
        let range = CUTOFF * SIGMA * spacing;
        let near = range * GUARD / (CUTOFF * SIGMA);
        let list = |block: usize| {
            let mut list = Vec::new();
            if is_left[block] {
                let moved = (self.moves, self.longest);
                let ground = self.ground;
                ground.near(
                    block,
                    moved,
                    range,
                    |to| is_left[to],
                    |meet, squared| {
                        list.push(Felt {
                            to: meet.to,
                            value: f64::from(ground.weight(block, &meet)) * exp(rate * squared),
                            press: PRESSURE * (1.0 - squared / (near * near)).max(0.0),
                        });
                    },
                );
            }
            list
        };
        let blocks = 0..is_left.len();
        self.lists = blocks.into_par_iter().map(list).collect();
        let sum = |list: &Vec<Felt>| list.iter().map(|felt| felt.value + felt.press).sum();
        Some(self.lists.iter().map(sum).collect())
    }

    fn leave(&self, block: usize, mut lose: impl FnMut(usize, f64)) {
        // The shares decide how many of these neighbors an instance of `to` has.
        for felt in &self.lists[block] {
            let to = felt.to as usize;
            let ratio = self.share(block) / self.share(to);
            lose(to, felt.value * ratio + felt.press);
        }
    }
}

/// The force on an instance of a block from another block.
struct Felt {
    to: u32,
    /// The Gaussian, weighted by frequency.
    value: f64,
    /// The penalty for being too near, however seldom they meet.
    press: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_finds_what_a_look_at_all_finds() {
        for count in [1u32, 2, 50] {
            // Many are equal.
            let mut potential: Vec<f64> = (0..count).map(|i| f64::from(i * 7919 % 5)).collect();
            let mut fullest = Fullest::new(potential.iter().copied());
            for step in 0.. {
                let all = potential
                    .iter()
                    .copied()
                    .zip(0..)
                    .filter(|(value, _)| *value > NONE);
                let first = all.reduce(|best, next| if next.0 > best.0 { next } else { best });
                assert_eq!(fullest.highest(), first);
                let Some((_, taken)) = first else { break };
                potential[taken] = NONE;
                fullest.set(taken, NONE);
                for block in (step % 3..potential.len()).step_by(3) {
                    potential[block] -= (block % 2) as f64;
                    fullest.set(block, potential[block]);
                }
            }
        }
    }
}
