//! The [order](crate::order) in which the blocks of a mix leave, for all kinds together and for each of them.
//!
//! A potential is a Gaussian sum over all that is left, and one over what is left of a block's own kind, each in units of its
//! own spacing. Points do not move.
//!
//! Kinds whose shares vary from place to place are cut from a second order. The points whose second rank lies in an
//! interval must be evenly spread, among all points and among those that are left when a set is thinned out by the ranks of
//! its table. So the second order is that of a mix whose kinds are the points by when they leave: the first quarter of the
//! ranks, the second, and the upper half.

use rayon::prelude::*;
use strew_core::{
    Table,
    table::{Mix, Ranks, Shares},
};

use super::press::each;
use crate::{
    ForgeError,
    numeric::exp,
    optimize::{Ground, longest, moves_of},
    order::{Surroundings, positions},
    watch::{Meter, Stage, Watch},
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
    let moves = moves_of(table);
    let longest = longest(&moves);
    let shares = each(mix.shares());
    let mut left = Left {
        ground: Ground::new(
            table.map(),
            CUTOFF * SIGMA * RAREST / LEAST.sqrt() + 2.0 * longest,
        ),
        moves,
        longest,
        labels: mix.labels(),
        shares: &shares,
        lists: Vec::new(),
        until: 1.0,
        rates: Vec::new(),
        meter,
        step: 0,
    };
    let fewest = FEWEST * shares.len();
    let found = positions(&mut left, mix.labels(), &shares, 1.0 - BATCH, fewest);
    let (step, meter) = (left.step, left.meter);
    let Some(found) = found.filter(|_| !meter.stop()) else {
        return Ok(None);
    };
    (step..STEPS).for_each(|_| meter.advance(None));
    Ok(Some(Ranks::new(found)?))
}

/// A pair of blocks that are left.
#[derive(Clone, Copy)]
struct Pair {
    to: u32,
    squared: f32,
    area: f32,
}

/// The blocks that are left, and how they press each other.
struct Left<'a, 'b> {
    ground: Ground,
    moves: Vec<[f64; 2]>,
    longest: f64,
    labels: &'a [u8],
    shares: &'a [f64],
    /// The neighbors of each block, which serve until only a share is left.
    lists: Vec<Vec<Pair>>,
    until: f64,
    /// The factors of squared distances in the exponents of the Gaussians: of all, then of each kind.
    rates: Vec<f64>,
    meter: &'a mut Meter<'b>,
    step: u32,
}

impl Left<'_, '_> {
    /// The neighbors of each block that serve until only a share is left.
    fn listed(&self, is_left: &[bool], until: f64) -> Vec<Vec<Pair>> {
        let range = CUTOFF * SIGMA / until.max(LEAST).sqrt();
        let list = |block: usize| {
            if !is_left[block] {
                return Vec::new();
            }
            let kind = self.labels[block];
            let far = range * (1.0 / self.shares[usize::from(kind)].sqrt()).min(RAREST);
            let mut list = Vec::with_capacity(256);
            let moved = (&self.moves[..], self.longest);
            let ground = &self.ground;
            ground.near(
                block,
                moved,
                far,
                |to| is_left[to],
                |meet, squared| {
                    let is_own = self.labels[meet.to as usize] == kind;
                    if is_own || squared < range * range {
                        list.push(Pair {
                            to: meet.to,
                            squared: squared as f32,
                            area: meet.area as f32,
                        });
                    }
                },
            );
            list.shrink_to_fit();
            list
        };
        (0..is_left.len()).into_par_iter().map(list).collect()
    }

    /// The addition of the other block of a pair to the potential, times the share of the block itself.
    #[inline]
    fn press(&self, block: usize, pair: &Pair) -> f64 {
        let squared = f64::from(pair.squared);
        let kind = self.labels[block];
        let mut sum = exp(self.rates[0] * squared);
        if self.labels[pair.to as usize] == kind {
            sum += OWN * exp(self.rates[1 + usize::from(kind)] * squared);
        }
        f64::from(pair.area) * sum
    }
}

impl Surroundings for Left<'_, '_> {
    fn share(&self, block: usize) -> f64 {
        self.ground.shares[block]
    }

    fn potentials(&mut self, is_left: &[bool], left: f64, target: f64) -> Option<Vec<f64>> {
        if left <= self.until {
            if self.meter.stop() {
                return None;
            }
            if self.step < STEPS {
                self.step += 1;
                self.meter.advance(None);
            }
            self.until = left * (1.0 - LISTING);
            self.lists = self.listed(is_left, self.until);
        }
        let rate = -0.5 * target.max(LEAST) / (SIGMA * SIGMA);
        let least = 1.0 / (RAREST * RAREST);
        let rates = self.shares.iter().map(|share| rate * share.max(least));
        self.rates = [rate].into_iter().chain(rates).collect();
        let of_block = |(block, list): (usize, &Vec<Pair>)| {
            let left = list.iter().filter(|pair| is_left[pair.to as usize]);
            let sum: f64 = left.map(|pair| self.press(block, pair)).sum();
            sum / self.share(block)
        };
        Some(self.lists.par_iter().enumerate().map(of_block).collect())
    }

    fn leave(&self, block: usize, mut lose: impl FnMut(usize, f64)) {
        for pair in &self.lists[block] {
            let to = pair.to as usize;
            lose(to, self.press(block, pair) / self.share(to));
        }
    }
}

/// The parts of the ranks that are each evenly ordered. More of them are no more even when thinned out, and
/// less so as a whole.
const PARTS: &str = "1:1:2";

/// Makes the second order of a table's blocks: the ranks of [`VaryingKinds`](strew_core::VaryingKinds). Takes about
/// a second on map m. `None` if it was stopped.
pub fn second_order(table: &Table, watch: &dyn Watch) -> Result<Option<Ranks>, ForgeError> {
    let shares: Shares = PARTS.parse()?;
    let sums = shares.parts().iter().scan(0.0, |sum, part| {
        *sum += f64::from(*part);
        Some(*sum / f64::from(shares.total()))
    });
    let ends: Vec<f64> = sums.take(shares.kinds() - 1).collect();
    let label = |block: usize| {
        let ranks = table.block_ranks(block);
        let middle = 0.5 * (ranks.start + ranks.end);
        ends.partition_point(|end| *end <= middle) as u8
    };
    let labels = (0..table.displacements().len()).map(label).collect();
    let mix = Mix::new(table.map(), shares, labels)?;
    let mut meter = Meter::new(watch, Stage::Optimizing, STEPS);
    order(table, &mix, &mut meter)
}
