//! The order in which the blocks of a table leave, by void and cluster on exact frequencies of pairs.
//!
//! The set starts full, and the block whose points are in the densest surroundings leaves first. Surroundings are sums of
//! Gaussians over the neighbors that are left, at the scale of the spacing that the set then has.

use strew_core::{Error, space::Table, table::Ranks};

use super::pairs::{Blocks, Pairs};

/// Below this share of the points neighbors are farther apart than pairs are listed.
const FEW: f64 = 1.0 / 24.0;

/// The table with an order in which its points leave.
///
/// # Errors
/// None for a table that exists.
pub fn with_ranks(table: &Table) -> Result<Table, Error> {
    let map = table.map();
    let units = map.alpha().set_side_f64() / 4096.0;
    let moves: Vec<[f32; 3]> = table
        .vectors()
        .iter()
        .map(|v| v.map(|v| (f64::from(v) * units) as f32))
        .collect();
    let blocks = Blocks::new(map, REACH);
    let pairs = blocks.pairs(&moves, REACH);
    let order = leave(&blocks, &pairs, &moves);
    let mut positions = vec![0; order.len()];
    for (position, &block) in (0..).zip(&order) {
        positions[block] = position;
    }
    table.with_ranks(Ranks::new(positions)?)
}

/// Pairs are listed up to this distance, in spacings of the whole set.
const REACH: f64 = 4.6;
/// The scale of surroundings, in spacings of what is left.
const SCALE: f64 = 0.55;

/// The blocks, the one that leaves last first.
fn leave(blocks: &Blocks, pairs: &Pairs, moves: &[[f32; 3]]) -> Vec<usize> {
    let number = moves.len();
    let mut is_left = vec![true; number];
    let mut left = 1.0f64;
    let mut order = Vec::with_capacity(number);
    // The scale changes in stages; at each the surroundings are summed up anew.
    while order.len() < number {
        let spacing = libm::cbrt(left.max(FEW)).recip();
        let sigma = SCALE * spacing;
        let scale = -0.5 / (sigma * sigma);
        let weight = |block: usize, pair: usize| {
            let other = usize::from(pairs.blocks[pair]);
            let squared: f64 = (0..3)
                .map(|axis| {
                    let by = f64::from(pairs.offsets[pair][axis]) * blocks.step;
                    let d = by + f64::from(moves[other][axis]) - f64::from(moves[block][axis]);
                    d * d
                })
                .sum();
            (scale * squared).max(-40.0)
        };
        let mut density = vec![0.0f64; number];
        for block in (0..number).filter(|&block| is_left[block]) {
            for pair in pairs.starts[block]..pairs.starts[block + 1] {
                if is_left[usize::from(pairs.blocks[pair])] {
                    let exponent = weight(block, pair) as f32;
                    density[block] += f64::from(pairs.shares[pair]) / blocks.shares[block]
                        * f64::from(crate::numeric::exp32(exponent));
                }
            }
        }
        let stage = 0.93 * left;
        loop {
            let candidates = (0..number).filter(|&block| is_left[block]);
            let next =
                candidates.max_by(|&a, &b| density[a].total_cmp(&density[b]).then(b.cmp(&a)));
            let Some(block) = next else {
                break;
            };
            is_left[block] = false;
            left -= blocks.shares[block];
            order.push(block);
            // The pair seen from the other point has the same frequency and distance.
            for pair in pairs.starts[block]..pairs.starts[block + 1] {
                let other = usize::from(pairs.blocks[pair]);
                if is_left[other] {
                    let exponent = weight(block, pair) as f32;
                    density[other] -= f64::from(pairs.shares[pair]) / blocks.shares[other]
                        * f64::from(crate::numeric::exp32(exponent));
                }
            }
            if left < stage {
                break;
            }
        }
    }
    order.reverse();
    order
}
