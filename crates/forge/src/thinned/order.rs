//! The order in which blocks leave: void and cluster (Ulichney 1993) over blocks instead of points.
//!
//! Again and again the block of the highest potential leaves, a Gaussian sum over what is left. σ is
//! 0.6 of the mean spacing that is left. Frequencies are exact, vectors are the table's own, and no
//! point moves.

use rayon::prelude::*;
use strew_core::{Table, table::Ranks};

use super::ground::{Ground, Neighbor, moves_of};
use crate::{ForgeError, numeric::exp};

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
    let left_last = leaving_order(&ground, &moves);
    let mut positions = vec![0; ground.blocks()];
    for (position, &block) in left_last.iter().rev().enumerate() {
        positions[block] = position as u32;
    }
    Ok(table.with_ranks(Ranks::new(positions)?)?)
}

/// The length of the longest move.
fn longest(moves: &[[f64; 2]]) -> f64 {
    let squared = moves.iter().map(|m| m[0] * m[0] + m[1] * m[1]);
    squared.fold(0.0, f64::max).sqrt()
}

/// The blocks in the order in which they leave.
fn leaving_order(ground: &Ground, moves: &[[f64; 2]]) -> Vec<usize> {
    let blocks = ground.blocks();
    let longest = longest(moves);
    let mut is_left = vec![true; blocks];
    let mut order = Vec::with_capacity(blocks);
    let mut left = 1.0;
    while blocks - order.len() > FEWEST {
        let target = left * (1.0 - BATCH);
        let spacing = 1.0 / target.max(LEAST).sqrt();
        let rate = -0.5 / (SIGMA * spacing * SIGMA * spacing);
        let range = CUTOFF * SIGMA * spacing;
        // Which blocks influence each other, and how much.
        let lists: Vec<Vec<Felt>> = (0..blocks)
            .into_par_iter()
            .map(|block| {
                let mut list = Vec::new();
                if is_left[block] {
                    let felt = |n: &Neighbor| felt(ground, moves, block, n, range, rate);
                    ground.neighbors(
                        block,
                        range + 2.0 * longest,
                        |to| is_left[to],
                        |neighbor| list.extend(felt(&neighbor)),
                    );
                }
                list
            })
            .collect();
        let mut potential: Vec<f64> = lists
            .iter()
            .map(|list| list.iter().map(|felt| felt.value + felt.press).sum())
            .collect();
        let mut first = true;
        while (left > target || first) && blocks - order.len() > FEWEST {
            first = false;
            let fullest = (0..blocks)
                .filter(|&b| is_left[b])
                .max_by(|&a, &b| potential[a].total_cmp(&potential[b]).then(b.cmp(&a)));
            let Some(block) = fullest else { break };
            is_left[block] = false;
            left -= ground.share(block);
            order.push(block);
            // The shares decide how many of these neighbors an instance of `to` has.
            for felt in &lists[block] {
                let to = felt.to as usize;
                let ratio = ground.share(block) / ground.share(to);
                potential[to] -= felt.value * ratio + felt.press;
            }
        }
    }
    order.extend((0..blocks).filter(|&b| is_left[b]));
    order
}

/// The force on an instance of a block from another block.
struct Felt {
    to: u32,
    /// The Gaussian, weighted by frequency.
    value: f64,
    /// The penalty for being too near, however seldom they meet.
    press: f64,
}

/// The force on an instance of a block from a neighbor, or `None` beyond the range.
fn felt(
    ground: &Ground,
    moves: &[[f64; 2]],
    block: usize,
    neighbor: &Neighbor,
    range: f64,
    rate: f64,
) -> Option<Felt> {
    let (own, other) = (moves[block], moves[neighbor.to as usize]);
    let dx = ground.scale() * f64::from(neighbor.i) + other[0] - own[0];
    let dy = ground.scale() * f64::from(neighbor.j) + other[1] - own[1];
    let squared = dx * dx + dy * dy;
    let near = range * GUARD / (CUTOFF * SIGMA);
    (squared < range * range).then(|| Felt {
        to: neighbor.to,
        value: f64::from(neighbor.weight) * exp(rate * squared),
        press: PRESSURE * (1.0 - squared / (near * near)).max(0.0),
    })
}
