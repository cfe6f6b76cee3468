//! The presses of blocks on each other: symmetric integers, so that an annealer adds them up and takes them away
//! in any order without a trace.

use rayon::prelude::*;
use strew_core::{Table, table::Shares};

use crate::{
    numeric::exp,
    optimize::{Ground, longest, moves_of},
};

/// A block that presses another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Press {
    pub(super) to: u32,
    /// The energy of both blocks being of the same kind.
    pub(super) by: i32,
}

/// For each block the others that press it, ascending.
pub(super) struct Presses {
    lists: Vec<Vec<Press>>,
    /// The press of each block on itself, from both ends.
    pub(super) own: Vec<i32>,
    /// The greatest press on each block by another one.
    pub(super) most: Vec<i32>,
}

/// A Gaussian of the distance, and where it ends. Lengths are in mean spacings of the full set.
#[derive(Clone, Copy)]
pub(super) struct Kernel {
    pub(super) sigma: f64,
    pub(super) range: f64,
}

impl Presses {
    /// Presses by a kernel, times the share of all points for which two blocks meet, times `unit`, rounded.
    pub(super) fn new(table: &Table, ground: &Ground, kernel: Kernel, unit: f64) -> Self {
        let vectors = table.displacements();
        let longest = longest(&moves_of(table));
        let scale = ground.scale;
        // A grid unit has 2²⁰ fixed-point units, and differences of places are exact in them.
        let fixed = scale / 1_048_576.0;
        let unit = unit / (scale * scale);
        let limit = (kernel.range / fixed) * (kernel.range / fixed);
        let rate = -0.5 * (fixed / kernel.sigma) * (fixed / kernel.sigma);
        let reach = kernel.range + 2.0 * longest;
        let each: Vec<(Vec<Press>, i32)> = (0..ground.shares.len())
            .into_par_iter()
            .map(|block| {
                let (mut found, mut own) = (Vec::with_capacity(256), 0);
                let at = vectors[block].map(i64::from);
                ground.meets(
                    block,
                    reach,
                    |_| true,
                    |meet| {
                        let other = vectors[meet.to as usize].map(i64::from);
                        let x = (i64::from(meet.i) << 20) + other[0] - at[0];
                        let y = (i64::from(meet.j) << 20) + other[1] - at[1];
                        let squared = (x * x + y * y) as f64;
                        if squared < limit {
                            let by = (meet.area * unit * exp(rate * squared)).round() as i32;
                            if meet.to as usize == block {
                                own += by;
                            } else if by != 0 {
                                found.push(Press { to: meet.to, by });
                            }
                        }
                    },
                );
                found.sort_unstable_by_key(|press| press.to);
                found.dedup_by(|later, first| {
                    let same = later.to == first.to;
                    if same {
                        first.by += later.by;
                    }
                    same
                });
                found.shrink_to_fit();
                (found, own)
            })
            .collect();
        let (lists, own): (Vec<_>, Vec<_>) = each.into_iter().unzip();
        let most = |list: &Vec<Press>| list.iter().map(|press| press.by).max().unwrap_or(0);
        Self {
            most: lists.iter().map(most).collect(),
            lists,
            own,
        }
    }

    /// The blocks that press a block.
    #[inline]
    pub(super) fn of(&self, block: usize) -> &[Press] {
        &self.lists[block]
    }

    /// The press of two different blocks on each other.
    #[inline]
    pub(super) fn between(&self, a: usize, b: usize) -> i32 {
        let list = self.of(a);
        let found = list.binary_search_by_key(&(b as u32), |press| press.to);
        found.map_or(0, |at| list[at].by)
    }
}

/// The shares of kinds, one by one.
pub(super) fn each(shares: &Shares) -> Vec<f64> {
    let kinds = 0..shares.kinds() as u8;
    kinds.map(|kind| shares.of(kind)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn presses_are_symmetric_sums_over_all_places_where_blocks_meet() {
        let alpha = "(5-sqrt(3))/2".parse().expect("valid");
        let table = Table::undisplaced(alpha, 15, "pattern").expect("small");
        let ground = Ground::new(table.map(), 5.0);
        let (sigma, range, unit) = (0.9, 2.5, 1e9);
        let presses = Presses::new(&table, &ground, Kernel { sigma, range }, unit);
        let moves = moves_of(&table);
        for block in 0..ground.shares.len() {
            let mut expected = vec![0.0; ground.shares.len()];
            ground.near(
                block,
                (&moves, longest(&moves)),
                range,
                |_| true,
                |meet, squared| {
                    let value = (-squared / (2.0 * sigma * sigma)).exp();
                    let share = f64::from(ground.weight(block, &meet)) * ground.shares[block];
                    expected[meet.to as usize] += share * value * unit;
                },
            );
            for (to, expected) in expected.into_iter().enumerate() {
                let found = match to == block {
                    true => presses.own[block],
                    false => presses.between(block, to),
                };
                assert!((f64::from(found) - expected).abs() < 1e-6 * expected + 4.0);
                if to != block {
                    assert_eq!(found, presses.between(to, block));
                    assert!(found <= presses.most[block]);
                }
            }
        }
    }
}
