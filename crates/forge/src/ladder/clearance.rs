//! Distances along a ladder, exactly: the least over every pair of blocks at every share, and what lifts
//! the pairs that come too near.
//!
//! Along a segment the difference of two places is linear in the way between the starts and ends of the
//! two events, and the share is linear in the way. So δ², the squared distance times the share in units of
//! the hexagonal distance, is a cubic on each piece. A pair counts until the first of its blocks has left.

use rayon::prelude::*;

use super::{
    climb::{Blocks, Climb},
    segment::{Lists, Pair},
};

/// √(2/√3), the hexagonal distance in mean spacings, squared.
const HEXAGONAL_SQUARED: f64 = 1.154_700_538_379_251_5;
/// The reach of lists, in mean spacings of the thinned set: more than any distance to be kept.
const RANGE: f64 = 0.75;
/// The longest push, in mean spacings of the thinned set.
const LONGEST: f64 = 0.1;

/// A pair that is too near somewhere on a segment.
#[derive(Clone, Copy, Debug)]
struct Conflict {
    own: u32,
    pair: Pair,
    /// The part of the way at which it is nearest.
    way: f64,
}

/// The distances along a ladder.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Clearance {
    /// The least δ at any share, by segment.
    pub(super) least: Vec<f64>,
    /// The number of pairs nearer than the target.
    pub(super) conflicts: usize,
}

impl Clearance {
    /// The least δ of all.
    pub(super) fn delta_min(&self) -> f64 {
        self.least.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// The distances of a ladder.
pub(super) fn clearance(blocks: &Blocks, climb: &Climb) -> Clearance {
    let found = lists(blocks, climb)
        .par_iter()
        .enumerate()
        .map(|(segment, lists)| conflicts(blocks, climb, segment, lists, 0.0))
        .collect::<Vec<_>>();
    summary(&found)
}

fn summary(found: &[(f64, Vec<Conflict>)]) -> Clearance {
    Clearance {
        least: found.iter().map(|(least, _)| *least).collect(),
        conflicts: found.iter().map(|(_, conflicts)| conflicts.len()).sum(),
    }
}

fn lists(blocks: &Blocks, climb: &Climb) -> Vec<Lists> {
    (0..climb.segments())
        .into_par_iter()
        .map(|segment| Lists::new(blocks, climb, segment, RANGE))
        .collect()
}

/// Pushes apart the pairs that come nearer than `target`, until none do or for a number of rounds.
pub(super) fn clear(blocks: &Blocks, climb: &mut Climb, target: f64, rounds: usize) {
    let lists = lists(blocks, climb);
    for _ in 0..rounds {
        let found: Vec<_> = lists
            .par_iter()
            .enumerate()
            .map(|(segment, lists)| conflicts(blocks, climb, segment, lists, target))
            .collect();
        if summary(&found).conflicts == 0 {
            break;
        }
        // One after another, so that a later push sees the earlier ones.
        for (segment, (_, conflicts)) in found.iter().enumerate() {
            for conflict in conflicts {
                push(blocks, climb, segment, conflict, target);
            }
        }
    }
}

/// The least δ of a segment, and the pairs below the target.
fn conflicts(
    blocks: &Blocks,
    climb: &Climb,
    segment: usize,
    lists: &Lists,
    target: f64,
) -> (f64, Vec<Conflict>) {
    let mut least = f64::INFINITY;
    let mut found = Vec::new();
    for own in 0..climb.counts[segment + 1] {
        for pair in lists.of(own) {
            let to = pair.to as usize;
            // Each pair is listed from both ends, and fillers have no weight.
            let is_first = to > own || (to == own && (pair.j, pair.i) > (0, 0));
            if !is_first || pair.weight == 0.0 {
                continue;
            }
            let (squared, way) = nearest(blocks, climb, segment, own, pair);
            least = least.min(squared);
            if squared < target * target {
                found.push(Conflict {
                    own: own as u32,
                    pair: *pair,
                    way,
                });
            }
        }
    }
    (least.max(0.0).sqrt(), found)
}

/// The part of the way at which a position has left.
fn end_of(blocks: &Blocks, climb: &Climb, segment: usize, position: usize) -> f64 {
    let (above, below) = (climb.shares[segment], climb.shares[segment + 1]);
    ((above - blocks.floors[position]) / (above - below)).clamp(0.0, 1.0)
}

/// From one position to the other of a pair at a part of the way.
fn difference(
    blocks: &Blocks,
    climb: &Climb,
    segment: usize,
    own: usize,
    pair: &Pair,
    way: f64,
) -> [f64; 2] {
    let scale = blocks.ground.scale();
    let (a, b) = (
        climb.vector(segment, own, way),
        climb.vector(segment, pair.to as usize, way),
    );
    [
        scale * f64::from(pair.i) + b[0] - a[0],
        scale * f64::from(pair.j) + b[1] - a[1],
    ]
}

/// The least δ² of a pair, and where it is.
fn nearest(blocks: &Blocks, climb: &Climb, segment: usize, own: usize, pair: &Pair) -> (f64, f64) {
    let to = pair.to as usize;
    let end = end_of(blocks, climb, segment, to.max(own));
    let events = [own, to].map(|position| climb.events[segment + 1][position]);
    let mut ways = [
        0.0,
        events[0][0],
        events[0][1],
        events[1][0],
        events[1][1],
        end,
    ];
    ways[1..5].iter_mut().for_each(|way| *way = way.min(end));
    ways.sort_by(f64::total_cmp);
    let mut least = (f64::INFINITY, 0.0);
    for piece in ways.windows(2) {
        let (from, to) = (piece[0], piece[1]);
        let r = difference(blocks, climb, segment, own, pair, from);
        let s = difference(blocks, climb, segment, own, pair, to);
        let by = [s[0] - r[0], s[1] - r[1]];
        let (share, lost) = (
            climb.share_at(segment, from),
            climb.share_at(segment, from) - climb.share_at(segment, to),
        );
        // (q + 2p·u + m·u²)(share − lost·u), u from 0 to 1.
        let (q, p, m) = (
            r[0] * r[0] + r[1] * r[1],
            r[0] * by[0] + r[1] * by[1],
            by[0] * by[0] + by[1] * by[1],
        );
        let value = |u: f64| (q + 2.0 * p * u + m * u * u) * (share - lost * u) / HEXAGONAL_SQUARED;
        // Where its derivative vanishes: a·u² + b·u + c.
        let (a, b, c) = (
            -3.0 * m * lost,
            2.0 * (m * share - 2.0 * p * lost),
            2.0 * p * share - q * lost,
        );
        let mut try_at = |u: f64| {
            if (0.0..=1.0).contains(&u) && value(u) < least.0 {
                least = (value(u), from + u * (to - from));
            }
        };
        try_at(0.0);
        try_at(1.0);
        let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
        // The stable form of both roots.
        let half = -0.5 * (b + if b < 0.0 { -root } else { root });
        if a != 0.0 {
            try_at(half / a);
        }
        if half != 0.0 {
            try_at(c / half);
        }
    }
    least
}

/// Pushes a pair apart where it is nearest: the smallest change of its free vectors that suffices.
fn push(blocks: &Blocks, climb: &mut Climb, segment: usize, conflict: &Conflict, target: f64) {
    let Conflict { own, pair, way } = conflict;
    let (own, to) = (*own as usize, pair.to as usize);
    if to == own {
        return;
    }
    let share = climb.share_at(segment, *way);
    let by = difference(blocks, climb, segment, own, pair, *way);
    let distance = (by[0] * by[0] + by[1] * by[1]).sqrt();
    // A little more, or rounding would leave it below.
    let wanted = target * (1.0 + 1e-4) * (HEXAGONAL_SQUARED / share).sqrt();
    if distance >= wanted {
        return;
    }
    let missing = (wanted - distance).min(LONGEST / share.sqrt());
    let direction = if distance > 0.0 {
        by.map(|v| v / distance)
    } else {
        [1.0, 0.0]
    };
    // How much the distance follows each of the four vectors. Those of level 0 are the table's own.
    let follows = [own, to].map(|position| {
        let part = climb.part(segment, position, *way);
        [if segment == 0 { 0.0 } else { 1.0 - part }, part]
    });
    let squares: f64 = follows.iter().flatten().map(|v| v * v).sum();
    if squares < 1e-3 {
        return;
    }
    for (position, sign, follows) in [(own, -1.0, follows[0]), (to, 1.0, follows[1])] {
        for (level, follow) in follows.into_iter().enumerate() {
            let vector = &mut climb.moves[segment + level][position];
            for axis in 0..2 {
                vector[axis] += sign * direction[axis] * missing * follow / squares;
            }
        }
    }
}
