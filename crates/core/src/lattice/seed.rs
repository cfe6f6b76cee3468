//! Seeds, and the hash behind everything that looks random.

use crate::{pattern::IndexOrigin, table::Symmetry};

/// A seed chooses a piece of the unbounded pattern, by moving the lattice origin in index space, one of the
/// eight symmetries of the square, by which the table is turned, and a [warp](crate::Warp). Seed 0 leaves the
/// origin at index (0, 0) and the table as it is.
///
/// ```
/// use strew_core::{Placement, Seed, Spacing};
///
/// let [a, b] = [7, 8].map(|seed| Placement::new(Spacing::ONE, Seed(seed)));
/// assert_ne!(a.seed.origin(), b.seed.origin());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Seed(pub u64);

impl Seed {
    /// The index of the lattice origin.
    #[must_use]
    pub fn origin(self) -> IndexOrigin {
        if self.0 == 0 {
            return IndexOrigin::default();
        }
        let x = split_mix(self.0);
        IndexOrigin {
            x,
            y: split_mix(x ^ self.0),
        }
    }

    /// The symmetry by which the table is turned.
    pub(crate) const fn symmetry(self) -> Symmetry<2> {
        Symmetry::<2>::numbered((self.symmetry_bits() >> 61) as usize)
    }

    /// The symmetry by which a table of points in space is turned.
    pub(crate) const fn symmetry_in_space(self) -> Symmetry<3> {
        let bits = self.symmetry_bits();
        let order = ((bits & 0xffff_ffff) * 6) >> 32;
        Symmetry::<3>::numbered(((order << 3) | (bits >> 61)) as usize)
    }

    const fn symmetry_bits(self) -> u64 {
        match self.0 {
            0 => 0,
            seed => split_mix(seed ^ 0x5359_4d4d_4554_5259),
        }
    }
}

/// The finalizer of `SplitMix64` (Steele, Lea, Flood, "Fast splittable pseudorandom number
/// generators", 2014) after one step of its counter.
pub(crate) const fn split_mix(state: u64) -> u64 {
    let z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_choose_each_symmetry_of_the_cube() {
        let mut chosen = [0; Symmetry::<3>::ALL];
        for seed in 1..5000 {
            chosen[Seed(seed).symmetry_in_space().number()] += 1;
        }
        let even = chosen.iter().all(|number| (50..170).contains(number));
        assert!(even, "{chosen:?}");
    }
}
