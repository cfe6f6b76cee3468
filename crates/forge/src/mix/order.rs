//! The order in which the blocks of a mix leave: void and cluster over blocks (Ulichney 1993), for all
//! kinds together and for each of them.
//!
//! Again and again the block leaves that has the highest potential: half of it a Gaussian sum over all
//! that is left, half of it one over what is left of its own kind, each in units of its own spacing. Kinds
//! take turns, so that their shares stay what they are: a kind that has fewer points left than its share
//! waits. Points do not move.

use rayon::prelude::*;
use strew_core::Table;

use super::near::longest;
use crate::{
    ladder::{Ground, moves_of},
    numeric::exp,
};

/// σ in spacings of what is left, of all and of a kind.
const SIGMA: f64 = 0.65;
/// Where the Gaussian ends, in σ.
const CUTOFF: f64 = 3.6;
/// The part of the potential that is the kind's own.
const OWN: f64 = 0.5;
/// The part of the points left after which potentials are made again for the wider spacing.
const BATCH: f64 = 0.05;
/// The part of the points left after which neighbor lists are made again.
const LISTING: f64 = 0.4;
/// The share at which lists no longer grow.
const LEAST: f64 = 1.0 / 4096.0;
/// How far the share of a kind may lie above or below, as a part of all that is left.
const SLACK: f64 = 0.002;
/// The greatest spacing of a kind, in spacings of what is left of all.
const RAREST: f64 = 4.0;

/// A pair of blocks that are left.
#[derive(Clone, Copy)]
struct Pair {
    to: u32,
    squared: f32,
    area: f32,
}

/// What decides an order.
pub struct Rule { pub own: f64, pub sigma: f64, pub batch: f64, pub slack: f64 }

/// The position of each block, 0 for the one that leaves last.
pub(super) fn positions(
    table: &Table,
    labels: &[u8],
    shares: &[f64],
    rule: &Rule,
    stop: &dyn Fn() -> bool,
) -> Option<Vec<u32>> {
    let moves = moves_of(table);
    let longest = longest(table);
    let rarest = (1.0 / shares[0].sqrt()).min(RAREST);
    let reach = CUTOFF * rule.sigma / LEAST.sqrt() * rarest + 2.0 * longest;
    let ground = Ground::new(table.map(), reach.min(400.0));
    let _ = moves;
    let vectors = moves_of(table);
    let blocks = labels.len();
    let kinds = shares.len();
    let mut is_left = vec![true; blocks];
    let mut areas = vec![0.0; kinds];
    for block in 0..blocks {
        areas[labels[block] as usize] += ground.share(block);
    }
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); kinds];
    for block in 0..blocks {
        members[labels[block] as usize].push(block as u32);
    }
    let mut order: Vec<u32> = Vec::with_capacity(blocks);
    let mut left = 1.0f64;
    let fewest = 4 * kinds;
    while blocks - order.len() > fewest {
        if stop() {
            return None;
        }
        // Lists that serve until much fewer are left.
        let until = (left * (1.0 - LISTING)).max(0.0);
        let wide = 1.0 / until.max(LEAST).sqrt();
        let range = CUTOFF * rule.sigma * wide;
        let lists: Vec<Vec<Pair>> = (0..blocks)
            .into_par_iter()
            .map(|block| {
                if !is_left[block] {
                    return Vec::new();
                }
                let kind = labels[block];
                let far = range * (1.0 / shares[kind as usize].sqrt()).min(RAREST);
                let (near, far) = (range * range, far * far);
                let mut list = Vec::with_capacity(256);
                let at = vectors[block];
                ground.meets(block, far.sqrt() + 2.0 * longest, |to| is_left[to], |meet| {
                    let other = vectors[meet.to as usize];
                    let x = ground.scale() * f64::from(meet.i) + other[0] - at[0];
                    let y = ground.scale() * f64::from(meet.j) + other[1] - at[1];
                    let squared = x * x + y * y;
                    let same = labels[meet.to as usize] == kind;
                    if squared < near || (same && squared < far) {
                        list.push(Pair {
                            to: meet.to,
                            squared: squared as f32,
                            area: meet.area as f32,
                        });
                    }
                });
                list.shrink_to_fit();
                list
            })
            .collect();
        while left > until && blocks - order.len() > fewest {
            let target = left * (1.0 - rule.batch);
            let spacing = 1.0 / target.max(LEAST).sqrt();
            let all = -0.5 / (rule.sigma * spacing * rule.sigma * spacing);
            let each: Vec<f64> = shares
                .iter()
                .map(|share| all * share.max(1.0 / (RAREST * RAREST)))
                .collect();
            let press = |block: usize, pair: &Pair| {
                let squared = f64::from(pair.squared);
                let kind = labels[block];
                let mut sum = (1.0 - rule.own) * exp((all * squared).max(-600.0));
                if labels[pair.to as usize] == kind {
                    sum += rule.own * exp((each[kind as usize] * squared).max(-600.0));
                }
                f64::from(pair.area) * sum
            };
            let mut potential: Vec<f64> = (0..blocks)
                .into_par_iter()
                .map(|block| {
                    let list = lists[block].iter().filter(|pair| is_left[pair.to as usize]);
                    let sum: f64 = list.map(|pair| press(block, pair)).sum();
                    sum / ground.share(block)
                })
                .collect();
            let mut first = true;
            while (left > target || first) && blocks - order.len() > fewest {
                first = false;
                // Kinds that have more left than their share may lose a block, and at least one does.
                let over = |kind: usize| areas[kind] / left - shares[kind];
                let most = (0..kinds).map(over).fold(f64::NEG_INFINITY, f64::max);
                let mut fullest: Option<(f64, usize, usize)> = None;
                for kind in 0..kinds {
                    if over(kind) < most.min(-rule.slack) || (over(kind) < -rule.slack && over(kind) < most) {
                        continue;
                    }
                    for (at, &block) in members[kind].iter().enumerate() {
                        let value = potential[block as usize];
                        if fullest.is_none_or(|(best, ..)| value > best) {
                            fullest = Some((value, kind, at));
                        }
                    }
                }
                let Some((_, kind, at)) = fullest else { break };
                let block = members[kind].swap_remove(at) as usize;
                is_left[block] = false;
                left -= ground.share(block);
                areas[kind] -= ground.share(block);
                order.push(block as u32);
                for pair in &lists[block] {
                    let to = pair.to as usize;
                    if is_left[to] {
                        potential[to] -= press(block, pair) / ground.share(to);
                    }
                }
            }
        }
    }
    order.extend((0..blocks as u32).filter(|&block| is_left[block as usize]));
    let mut positions = vec![0; blocks];
    for (position, &block) in (0..).zip(order.iter().rev()) {
        positions[block as usize] = position;
    }
    Some(positions)
}
