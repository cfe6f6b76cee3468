//! The symmetries of the cube.

use crate::sample::{Seed, split_mix};

/// One of the 48 symmetries of the cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Symmetry {
    /// The axis of the table that each axis of the set shows.
    axes: [usize; 3],
    /// Whether each axis of the set is reversed.
    reversed: [bool; 3],
}

/// The orders of three axes.
const ORDERS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
];

impl Symmetry {
    /// The number of symmetries.
    pub(super) const ALL: usize = 48;

    /// The symmetry that a seed chooses.
    pub(super) const fn of(seed: Seed) -> Self {
        if seed.0 == 0 {
            return Self::numbered(0);
        }
        let hash = split_mix(seed.0 ^ 0x5359_4d4d_4554_5259);
        let order = ((hash & 0xffff_ffff) * 6) >> 32;
        Self::numbered(((order << 3) | (hash >> 61)) as usize)
    }

    /// Symmetry number `number`: the lowest three bits reverse axes.
    pub(super) const fn numbered(number: usize) -> Self {
        Self {
            axes: ORDERS[number >> 3],
            reversed: [number & 1 != 0, number & 2 != 0, number & 4 != 0],
        }
    }

    /// The number of the symmetry.
    pub(super) fn number(self) -> usize {
        let order = ORDERS.iter().position(|order| *order == self.axes);
        let bits = (0..3).map(|axis| usize::from(self.reversed[axis]) << axis);
        order.unwrap_or(0) << 3 | bits.sum::<usize>()
    }

    /// The block of the table at a block of the set, in a map of n intervals an axis.
    pub(super) fn source(self, n: usize, block: [usize; 3]) -> [usize; 3] {
        let mut source = [0; 3];
        for axis in 0..3 {
            let place = block[axis];
            source[self.axes[axis]] = if self.reversed[axis] {
                n - 1 - place
            } else {
                place
            };
        }
        source
    }

    /// A vector of the table as one of the set.
    pub(super) fn turn(self, vector: [i16; 3]) -> [i16; 3] {
        [0, 1, 2].map(|axis| {
            let v = vector[self.axes[axis]];
            if self.reversed[axis] { -v } else { v }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_are_different_and_seeds_choose_each() {
        let mut chosen = [0; Symmetry::ALL];
        for seed in 1..5000 {
            chosen[Symmetry::of(Seed(seed)).number()] += 1;
        }
        assert!(
            chosen.iter().all(|&number| (50..170).contains(&number)),
            "{chosen:?}"
        );
        for number in 0..Symmetry::ALL {
            let symmetry = Symmetry::numbered(number);
            assert_eq!(symmetry.number(), number);
            let images = [[1, 2, 3], [3, 1, 2]].map(|vector| symmetry.turn(vector));
            let others = (0..number).map(Symmetry::numbered);
            assert!(
                others
                    .into_iter()
                    .all(|other| other.turn([1, 2, 3]) != images[0])
            );
            assert_eq!(images[1].iter().map(|v| v.abs()).sum::<i16>(), 6);
        }
    }
}
