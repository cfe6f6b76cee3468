//! The order in which the blocks of a mix leave: void and cluster over blocks (Ulichney 1993), for all
//! kinds together and for each of them.
//!
//! Again and again the block leaves that has the highest potential: a Gaussian sum over all that is left, and
//! one over what is left of its own kind, each in units of its own spacing. A kind that has fallen behind its
//! share of what is left waits, so that shares stay what they are. Points do not move.

use rayon::prelude::*;
use strew_core::{
    Table,
    table::{Mix, Ranks},
};

use super::{fullest::Fullest, press::longest};
use crate::{
    ForgeError,
    numeric::exp,
    thinned::{Ground, moves_of},
    watch::Meter,
};

/// σ in spacings of what is left, of all and of a kind.
const SIGMA: f64 = 0.65;
/// The weight of a kind's own Gaussian; that of all is 1.
const OWN: f64 = 1.15;
/// The cut-off of the Gaussian, in σ.
const CUTOFF: f64 = 3.6;
/// The part of the points left after which potentials are made again for the wider spacing.
const BATCH: f64 = 0.05;
/// The part of the points left after which neighbor lists are made again.
const LISTING: f64 = 0.4;
/// The share at which lists no longer grow: below it neighbors lie farther apart than lists reach.
const LEAST: f64 = 1.0 / 4096.0;
/// The tolerated fall of a kind's share among the points that are left: absolute, and relative to its share.
const SLACK: [f64; 2] = [0.002, 0.03];
/// The greatest spacing of a kind that counts, in spacings of all that is left.
const RAREST: f64 = 4.0;
/// The fewest blocks a kind among which potentials still decide.
const FEWEST: usize = 4;
/// Steps of the meter.
pub(super) const STEPS: u32 = 20;

/// The order in which the blocks of a mix leave, or `None` if the meter's watch stopped the work. It takes
/// [`STEPS`] steps.
pub(super) fn order(
    table: &Table,
    mix: &Mix,
    meter: &mut Meter<'_>,
) -> Result<Option<Ranks>, ForgeError> {
    let mut leaving = Leaving::new(table, mix);
    for step in 0.. {
        if meter.stop() {
            return Ok(None);
        }
        let done = leaving.is_done();
        if step < STEPS || done {
            let steps = if done { STEPS.saturating_sub(step) } else { 1 };
            (0..steps).for_each(|_| meter.advance(None));
        }
        if done {
            break;
        }
        leaving.thin();
    }
    Ok(Some(Ranks::new(leaving.positions())?))
}

/// A pair of blocks that are left.
#[derive(Clone, Copy)]
struct Pair {
    to: u32,
    squared: f32,
    area: f32,
}

/// The blocks that are left and those that are not, in the order in which they left.
struct Leaving {
    ground: Ground,
    moves: Vec<[f64; 2]>,
    longest: f64,
    labels: Vec<u8>,
    /// The shares of kinds, and what is left of each.
    shares: Vec<f64>,
    areas: Vec<f64>,
    /// The blocks left of each kind.
    members: Vec<Vec<u32>>,
    is_left: Vec<bool>,
    left: f64,
    order: Vec<u32>,
}

/// The two Gaussians at a share: factors of squared distances in exponents.
struct Law {
    all: f64,
    kinds: Vec<f64>,
}

impl Leaving {
    fn new(table: &Table, mix: &Mix) -> Self {
        let labels = mix.labels().to_vec();
        let kinds = mix.shares().kinds();
        let longest = longest(table);
        let reach = CUTOFF * SIGMA * RAREST / LEAST.sqrt() + 2.0 * longest;
        let ground = Ground::new(table.map(), reach);
        let mut members = vec![Vec::new(); kinds];
        let mut areas = vec![0.0; kinds];
        for (block, &kind) in labels.iter().enumerate() {
            members[usize::from(kind)].push(block as u32);
            areas[usize::from(kind)] += ground.share(block);
        }
        Self {
            moves: moves_of(table),
            longest,
            shares: (0..kinds as u8).map(|k| mix.shares().of(k)).collect(),
            areas,
            members,
            is_left: vec![true; labels.len()],
            left: 1.0,
            order: Vec::with_capacity(labels.len()),
            ground,
            labels,
        }
    }

    fn is_done(&self) -> bool {
        self.labels.len() - self.order.len() <= FEWEST * self.shares.len()
    }

    /// The position of each block, 0 for the one that leaves last.
    fn positions(mut self) -> Vec<u32> {
        let rest = (0..).zip(&self.is_left).filter(|(_, left)| **left);
        self.order.extend(rest.map(|(block, _)| block));
        let mut positions = vec![0; self.order.len()];
        for (position, &block) in (0..).zip(self.order.iter().rev()) {
            positions[block as usize] = position;
        }
        positions
    }

    /// Takes blocks away until lists have to be made again.
    fn thin(&mut self) {
        let until = self.left * (1.0 - LISTING);
        let lists = self.lists(until);
        while self.left > until && !self.is_done() {
            self.take_batch(&lists);
        }
    }

    /// The neighbors of each block that serve while more than a share is left.
    fn lists(&self, until: f64) -> Vec<Vec<Pair>> {
        let range = CUTOFF * SIGMA / until.max(LEAST).sqrt();
        let scale = self.ground.scale();
        let list = |block: usize| {
            if !self.is_left[block] {
                return Vec::new();
            }
            let kind = self.labels[block];
            let far = range * (1.0 / self.shares[usize::from(kind)].sqrt()).min(RAREST);
            let at = self.moves[block];
            let mut list = Vec::with_capacity(256);
            let is_left = |to: usize| self.is_left[to];
            let reach = far + 2.0 * self.longest;
            self.ground.meets(block, reach, is_left, |meet| {
                let to = meet.to as usize;
                let x = scale * f64::from(meet.i) + self.moves[to][0] - at[0];
                let y = scale * f64::from(meet.j) + self.moves[to][1] - at[1];
                let squared = x * x + y * y;
                let range = if self.labels[to] == kind { far } else { range };
                if squared < range * range {
                    list.push(Pair {
                        to: meet.to,
                        squared: squared as f32,
                        area: meet.area as f32,
                    });
                }
            });
            list.shrink_to_fit();
            list
        };
        (0..self.labels.len()).into_par_iter().map(list).collect()
    }

    /// The Gaussians where a share is left.
    fn law(&self, share: f64) -> Law {
        let all = -0.5 * share.max(LEAST) / (SIGMA * SIGMA);
        let least = 1.0 / (RAREST * RAREST);
        let kinds = self.shares.iter().map(|share| all * share.max(least));
        Law {
            all,
            kinds: kinds.collect(),
        }
    }

    /// The addition of the other block of a pair to the potential, times the share of the block itself.
    #[inline]
    fn press(&self, law: &Law, block: usize, pair: &Pair) -> f64 {
        let squared = f64::from(pair.squared);
        let kind = self.labels[block];
        let mut sum = exp(law.all * squared);
        if self.labels[pair.to as usize] == kind {
            sum += OWN * exp(law.kinds[usize::from(kind)] * squared);
        }
        f64::from(pair.area) * sum
    }

    /// Takes a batch of blocks away.
    fn take_batch(&mut self, lists: &[Vec<Pair>]) {
        let target = self.left * (1.0 - BATCH);
        let law = self.law(target);
        let of_block = |(block, list): (usize, &Vec<Pair>)| {
            let left = list.iter().filter(|pair| self.is_left[pair.to as usize]);
            let sum: f64 = left.map(|pair| self.press(&law, block, pair)).sum();
            sum / self.ground.share(block)
        };
        let mut potential: Vec<f64> = lists.par_iter().enumerate().map(of_block).collect();
        let mut fullest = Fullest::new(&self.members, &potential);
        let mut first = true;
        while (self.left > target || first) && !self.is_done() {
            first = false;
            let Some((kind, at)) = self.leaving(&fullest) else {
                return;
            };
            let block = fullest.take(&mut self.members, kind, at);
            let share = self.ground.share(block);
            self.is_left[block] = false;
            self.left -= share;
            self.areas[kind] -= share;
            self.order.push(block as u32);
            for pair in &lists[block] {
                let to = pair.to as usize;
                if self.is_left[to] {
                    potential[to] -= self.press(&law, block, pair) / self.ground.share(to);
                    fullest.set(self.labels[to].into(), to, potential[to]);
                }
            }
        }
    }

    /// The block of the highest potential among the kinds that may lose one: its kind, and its place there.
    fn leaving(&self, fullest: &Fullest) -> Option<(usize, usize)> {
        let excess = |kind: usize| {
            let share = self.shares[kind];
            (self.areas[kind] / self.left - share) / SLACK[0].min(SLACK[1] * share)
        };
        let kinds = (0..self.shares.len()).filter(|&kind| !self.members[kind].is_empty());
        let most = kinds.clone().map(excess).fold(f64::NEG_INFINITY, f64::max);
        let may_lose = kinds.filter(|&kind| excess(kind) >= most.min(-1.0));
        let places = may_lose.filter_map(|kind| {
            let (potential, at) = fullest.of_kind(kind)?;
            Some((potential, kind, at))
        });
        // The first of equal ones.
        let higher = |best: (f64, usize, usize), next: (f64, usize, usize)| {
            if next.0 > best.0 { next } else { best }
        };
        places.reduce(higher).map(|(_, kind, at)| (kind, at))
    }
}
