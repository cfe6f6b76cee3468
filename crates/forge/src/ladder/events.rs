//! When each block moves within a segment: when its near neighbors leave.

use rayon::prelude::*;

use super::{
    climb::{Blocks, Climb},
    segment::Lists,
};
use crate::numeric::exp;

/// The width of the neighborhood, in mean spacings of the thinned set: σ of a Gaussian.
const NEAR: f64 = 0.6;
/// The shortest event, as a part of a segment.
const SHORTEST: f64 = 0.15;
/// The growth of an event's length with the standard deviation of the neighbors' times.
const SPREAD: f64 = 2.5;
/// The reach of lists for events, in mean spacings of the thinned set.
const RANGE: f64 = 2.6;
/// The weight of leaving neighbors below which a block has none.
const ALONE: f64 = 1e-3;

/// Sets all events: each is centered at the mean time at which near neighbors leave, and its length is the spread of
/// these times. A block without such neighbors moves all the way.
pub(super) fn time(blocks: &Blocks, climb: &mut Climb) {
    let all: Vec<Vec<[f64; 2]>> = (0..climb.segments())
        .into_par_iter()
        .map(|segment| of_segment(blocks, climb, segment))
        .collect();
    for (events, k) in all.into_iter().zip(1..) {
        climb.events[k] = events;
    }
}

fn of_segment(blocks: &Blocks, climb: &Climb, segment: usize) -> Vec<[f64; 2]> {
    let (above, below) = (climb.shares[segment], climb.shares[segment + 1]);
    let lists = Lists::new(blocks, climb, segment, RANGE);
    let spacing = 1.0 / above.sqrt();
    let rate = -0.5 / (NEAR * spacing * NEAR * spacing);
    let middle = |position: usize| {
        let ends = [0, 1].map(|k| climb.moves[segment + k][position]);
        [0, 1].map(|axis| 0.5 * (ends[0][axis] + ends[1][axis]))
    };
    let scale = blocks.ground.scale();
    let event = |own: usize| {
        let place = middle(own);
        let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
        for pair in lists.of(own) {
            let to = pair.to as usize;
            let leaves = 0.5 * (blocks.floors[to] + blocks.floors[to + 1]);
            if leaves <= below || leaves > above {
                continue;
            }
            let there = middle(to);
            let dx = scale * f64::from(pair.i) + there[0] - place[0];
            let dy = scale * f64::from(pair.j) + there[1] - place[1];
            let weight = f64::from(pair.weight) * exp((rate * (dx * dx + dy * dy)).max(-600.0));
            let way = (above - leaves) / (above - below);
            sum += weight;
            first += weight * way;
            second += weight * way * way;
        }
        if sum <= ALONE {
            return [0.0, 1.0];
        }
        let mean = first / sum;
        let deviation = (second / sum - mean * mean).max(0.0).sqrt();
        centered(mean, (SHORTEST + SPREAD * deviation).min(1.0))
    };
    (0..climb.counts[segment + 1]).map(event).collect()
}

/// The event of a length whose middle is as near as possible to a place.
fn centered(middle: f64, length: f64) -> [f64; 2] {
    let start = (middle - length / 2.0).clamp(0.0, 1.0 - length);
    [start, (start + length).min(1.0)]
}
