//! The Gaussian energy of a table, over all pairs of the unbounded set, and its gradient.

use rayon::prelude::*;

use super::pairs::{Blocks, Pairs};
use crate::numeric::exp32;

/// The number of pairs that are evaluated together.
const LANES: usize = 16;

/// Repulsion by exp(−d²/2σ²), cut off and shifted to 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gaussian {
    /// σ, in mean spacings.
    pub(super) sigma: f64,
}

impl Gaussian {
    /// The distance beyond which pairs count as 0, in mean spacings.
    pub(super) fn reach(self) -> f64 {
        5.0 * self.sigma
    }

    /// The energy per point, and the gradient of each block per point of the block, times σ²: the sum of w·d over the
    /// pairs of its points, with d from the other point.
    pub(super) fn evaluate(
        self,
        blocks: &Blocks,
        pairs: &Pairs,
        moves: &[[f32; 3]],
        forces: &mut [[f64; 3]],
    ) -> f64 {
        let scale = (-0.5 / (self.sigma * self.sigma)) as f32;
        let limit = (self.reach() * self.reach()) as f32;
        let shift = exp32(scale * limit);
        let one = |block: usize, force: &mut [f64; 3]| {
            let all = pairs.starts[block]..pairs.starts[block + 1];
            let own = moves[block];
            let (mut sum, mut total) = ([0.0f64; 3], 0.0f64);
            let mut at = all.start;
            while at < all.end {
                let part = at..all.end.min(at + LANES);
                let mut places = [[0.0f32; LANES]; 3];
                let mut shares = [0.0f32; LANES];
                for (lane, pair) in part.clone().enumerate() {
                    let other = moves[usize::from(pairs.blocks[pair])];
                    let offset = pairs.offsets[pair];
                    for axis in 0..3 {
                        let by = f32::from(offset[axis]) * blocks.step as f32;
                        places[axis][lane] = own[axis] - other[axis] - by;
                    }
                    shares[lane] = pairs.shares[pair];
                }
                let mut weights = [0.0f32; LANES];
                for lane in 0..LANES {
                    let [x, y, z] = [places[0][lane], places[1][lane], places[2][lane]];
                    let squared = (x * x + y * y + z * z).min(limit);
                    weights[lane] = (exp32(scale * squared) - shift) * shares[lane];
                }
                for lane in 0..LANES {
                    let weight = weights[lane];
                    total += f64::from(weight);
                    for axis in 0..3 {
                        sum[axis] += f64::from(weight * places[axis][lane]);
                    }
                }
                at = part.end;
            }
            let share = blocks.shares[block];
            *force = sum.map(|v| v / share);
            total
        };
        // Each sum is of one thread, and they are added in order.
        let all = forces.par_iter_mut().enumerate();
        let totals: Vec<f64> = all.map(|(block, force)| one(block, force)).collect();
        totals.iter().sum()
    }
}
