//! Push and pull: points that are too near push each other apart, until a target distance is kept everywhere.

use super::{
    descent::{SpaceState, single},
    pairs::Blocks,
};

/// The target distances at the start and at the end, in mean spacings: 0.76 and 0.86 of the densest packing's.
const TARGETS: [f64; 2] = [0.853, 0.965];

/// Moves blocks apart, one step of `steps`. Returns the least distance before it, in mean spacings.
pub(super) fn push(blocks: &Blocks, state: &mut SpaceState, steps: u32) -> f64 {
    let part = f64::from(state.step) / f64::from(steps.max(2) - 1);
    let target = TARGETS[0] + (TARGETS[1] - TARGETS[0]) * part;
    let places = single(&state.moves);
    let mut sums = vec![([0.0f64; 3], 0.0f64); places.len()];
    let mut least = f64::INFINITY;
    blocks.each_pair(&places, target, |from, to, offset, _| {
        let d = [0, 1, 2].map(|axis| {
            f64::from(offset[axis]) * blocks.step + f64::from(places[to][axis])
                - f64::from(places[from][axis])
        });
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        least = least.min(length);
        if length > 1e-9 {
            let lack = target - length;
            let (sum, weight) = &mut sums[from];
            // The nearest pairs count most.
            let own = lack * lack;
            for axis in 0..3 {
                sum[axis] -= d[axis] / length * lack * own;
            }
            *weight += own;
        }
    });
    if least > state.least {
        (state.least, state.best) = (least, state.moves.clone());
    }
    for (v, (sum, weight)) in state.moves.iter_mut().zip(&sums) {
        if *weight > 0.0 {
            for axis in 0..3 {
                v[axis] += 0.55 * sum[axis] / weight;
            }
            let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
            if length > blocks.longest {
                *v = v.map(|v| v * (blocks.longest / length));
            }
        }
    }
    state.step += 1;
    least
}
