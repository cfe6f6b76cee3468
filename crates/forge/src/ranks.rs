//! The [order](crate::order) in which the blocks of a table leave. A potential is a Gaussian sum over what is left.
//! σ is 0.6 of the mean spacing that is left. Frequencies are exact, vectors are the table's own, and no point moves.

use rayon::prelude::*;
use strew_core::{Table, table::Ranks};

use crate::{
    ForgeError,
    numeric::exp,
    optimize::{Ground, longest, moves_of},
    order::{Surroundings, positions},
};

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
///
/// # Errors
/// [`ForgeError::Table`] if the table with its ranks is not valid.
///
/// ```
/// use strew_core::Table;
/// use strew_forge::with_ranks;
///
/// let table = Table::undisplaced("sqrt(3)".parse()?, 12, "pattern")?;
/// let ranked = with_ranks(&table)?;
/// assert!(table.ranks().is_none() && ranked.ranks().is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
