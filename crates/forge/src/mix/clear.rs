//! Least distances of a mix, exactly: over every pair of blocks that meet, however seldom, and what lifts
//! the pairs that come too near.

use rayon::prelude::*;

use crate::{
    measure::HEXAGONAL,
    optimize::{Ground, longest},
};

/// Lists reach this much farther than the distance to keep.
const SKIN: f64 = 1.25;

/// The least δ to keep.
#[derive(Clone, Copy, Debug)]
pub(super) struct Floor {
    /// Between any two points, in hexagonal distances of all.
    pub(super) all: f64,
    /// Between two points of a kind, in its own.
    pub(super) kind: f64,
}

/// Two blocks that may come too near: where one is seen from the other, and the distance to keep.
struct Near {
    own: u32,
    to: u32,
    by: [f64; 2],
    least: f64,
}

/// Pushes apart the pairs that are too near, until none are or for a number of rounds. Moves are in mean
/// spacings; `kinds` has the part of each block that is of each kind. Returns the number of pairs that are
/// still too near.
pub(super) fn clear(
    ground: &Ground,
    kinds: &[Vec<f64>],
    shares: &[f64],
    moves: &mut [[f64; 2]],
    floor: Floor,
    rounds: usize,
) -> usize {
    let pairs = pairs(ground, kinds, shares, moves, floor);
    let mut near = 0;
    for round in 0..=rounds {
        near = 0;
        for pair in &pairs {
            let (own, to) = (moves[pair.own as usize], moves[pair.to as usize]);
            let by = [0, 1].map(|axis| pair.by[axis] + to[axis] - own[axis]);
            let squared = by[0] * by[0] + by[1] * by[1];
            if squared >= pair.least * pair.least {
                continue;
            }
            near += 1;
            if round == rounds {
                continue;
            }
            let distance = squared.sqrt();
            // A little more, or rounding would leave it below.
            let missing = 0.5 * (pair.least * (1.0 + 1e-4) - distance);
            for axis in 0..2 {
                let push = if distance > 0.0 {
                    by[axis] / distance * missing
                } else {
                    missing
                };
                moves[pair.own as usize][axis] -= push;
                moves[pair.to as usize][axis] += push;
            }
        }
        if near == 0 {
            break;
        }
    }
    near
}

/// The pairs of different blocks that are near, each once.
fn pairs(
    ground: &Ground,
    kinds: &[Vec<f64>],
    shares: &[f64],
    moves: &[[f64; 2]],
    floor: Floor,
) -> Vec<Near> {
    let all = floor.all * HEXAGONAL;
    let of_kind = |share: f64| (floor.kind * HEXAGONAL / share.sqrt()).max(all);
    let widest = shares
        .iter()
        .map(|&share| of_kind(share))
        .fold(all, f64::max);
    let moved = (moves, longest(moves));
    let list = |own: usize| {
        let mut list = Vec::new();
        ground.near(
            own,
            moved,
            widest * SKIN,
            |to| to > own,
            |meet, squared| {
                let to = meet.to as usize;
                let shared = kinds.iter().zip(shares);
                let shared = shared.filter(|(kind, _)| kind[own] > 0.0 && kind[to] > 0.0);
                let least = shared.map(|(_, &share)| of_kind(share)).fold(all, f64::max);
                if squared < (least * SKIN) * (least * SKIN) {
                    list.push(Near {
                        own: own as u32,
                        to: meet.to,
                        by: [meet.i, meet.j].map(|v| ground.scale * f64::from(v)),
                        least,
                    });
                }
            },
        );
        list
    };
    let lists: Vec<Vec<Near>> = (0..moves.len()).into_par_iter().map(list).collect();
    lists.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use strew_core::{
        Map, Table, Twin,
        table::{Mix, Provenance, Ranks, from_grid_units},
    };

    use super::*;
    use crate::{measure::Distances, measure::ThinnedTwin, mix::joint::parts, optimize::moves_of};

    #[test]
    fn cleared_pairs_are_clear_on_a_twin() {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 20).expect("small");
        let table = Table::undisplaced(map.alpha(), 20, "pattern").expect("small");
        let mix = Mix::scattered(&map, "1:3".parse().expect("valid")).expect("near");
        let (kinds, ground) = (parts(&table, &mix), Ground::new(&map, 8.0));
        let mut moves = moves_of(&table);
        let floor = Floor {
            all: 0.4,
            kind: 0.45,
        };
        let shares = [0.25, 0.75];
        assert_eq!(clear(&ground, &kinds, &shares, &mut moves, floor, 400), 0);
        let grid = |v: f64| from_grid_units(v / ground.scale).expect("short");
        let vectors: Vec<_> = moves.iter().map(|m| m.map(grid)).collect();
        let ranks = Ranks::new((0..vectors.len() as u32).collect()).expect("each once");
        let table = Table::new(map, "cleared", vectors, Provenance::default()).expect("valid");
        let table = table.with_mix(mix, ranks).expect("valid");
        let twin = Twin::new(683, 418).expect("reduced");
        let points = ThinnedTwin::new(&table, twin).expect("a twin");
        assert!(Distances::of(&points.at(1.0, None)).delta_min > 0.399);
        for kind in 0..2 {
            let set = points.at(1.0, Some(kind));
            assert!(Distances::of(&set).delta_min > 0.449, "{kind}");
        }
    }
}
