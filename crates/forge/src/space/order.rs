//! The order in which the blocks of a table leave, by void and cluster on exact frequencies of pairs.
//!
//! The set starts full, and the block whose points are in the densest surroundings leaves first. Surroundings are sums of
//! Gaussians over the neighbors that are left, at the scale of the spacing that the set then has.

use strew_core::{Error, space::Table, table::Ranks};

use super::pairs::{Blocks, Pairs};
use crate::{
    numeric::exp32,
    order::{Surroundings, positions},
};

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
    let mut left = Left {
        blocks: &blocks,
        pairs: &pairs,
        moves: &moves,
        scale: 0.0,
    };
    let found = positions(&mut left, &vec![0; moves.len()], &[1.0], KEPT, 0);
    table.with_ranks(Ranks::new(found.unwrap_or_default())?)
}

/// Pairs are listed up to this distance, in spacings of the whole set.
const REACH: f64 = 4.6;
/// The scale of surroundings, in spacings of what is left.
const SCALE: f64 = 0.55;
/// The part of what was left that is left when surroundings are summed up anew, at another scale.
const KEPT: f64 = 0.93;

/// The blocks that are left, and how they press each other.
struct Left<'a> {
    blocks: &'a Blocks,
    pairs: &'a Pairs,
    moves: &'a [[f32; 3]],
    /// The exponent per squared distance.
    scale: f64,
}

impl Left<'_> {
    /// The pairs of a block: the other block, and the frequency of the pair times the Gaussian of its distance.
    fn of(&self, block: usize) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        let Self { pairs, moves, .. } = self;
        (pairs.starts[block]..pairs.starts[block + 1]).map(move |pair| {
            let other = usize::from(pairs.blocks[pair]);
            let squared: f64 = (0..3)
                .map(|axis| {
                    let by = f64::from(pairs.offsets[pair][axis]) * self.blocks.step;
                    let d = by + f64::from(moves[other][axis]) - f64::from(moves[block][axis]);
                    d * d
                })
                .sum();
            let exponent = (self.scale * squared).max(-40.0) as f32;
            (
                other,
                f64::from(pairs.shares[pair]),
                f64::from(exp32(exponent)),
            )
        })
    }
}

impl Surroundings for Left<'_> {
    fn share(&self, block: usize) -> f64 {
        self.blocks.shares[block]
    }

    fn potentials(&mut self, is_left: &[bool], left: f64, _: f64) -> Option<Vec<f64>> {
        let sigma = SCALE * libm::cbrt(left.max(FEW)).recip();
        self.scale = -0.5 / (sigma * sigma);
        let mut density = vec![0.0f64; is_left.len()];
        for block in (0..is_left.len()).filter(|&block| is_left[block]) {
            for (other, share, near) in self.of(block) {
                if is_left[other] {
                    density[block] += share / self.share(block) * near;
                }
            }
        }
        Some(density)
    }

    fn leave(&self, block: usize, mut lose: impl FnMut(usize, f64)) {
        // The pair seen from the other point has the same frequency and distance.
        for (other, share, near) in self.of(block) {
            lose(other, share / self.share(other) * near);
        }
    }
}
