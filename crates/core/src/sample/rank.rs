//! Ranks by place in index space: thinning that leaves a smaller set region.
//!
//! A point's rank is (max(dX, dY)/t)². The index is uniform over [0, t)², so the rank is exactly
//! uniform over the pattern; the points of rank below λ are those of the smaller set region
//! [0, t·√λ)², so they nest as λ grows, they are a union of four products again, and whatever is
//! counted in closed form stays so. Like membership itself it is decided by integers:
//! [`side_for`] gives the side at which comparing indices and comparing ranks agree to the bit.
//!
//! What is left is more even than a random choice on large scales, where density is felt, and not
//! between neighbors. Blue table, 63 intervals, power relative to the thinned set's own density
//! (random thinning leaves 1 − λ everywhere):
//!
//! | λ | power, ν < 0.2 | random | mean, ν < 0.5 | random | δ_min | random |
//! |---|---|---|---|---|---|---|
//! | 1/2 | 0.10 | 0.50 | 0.51 | 0.50 | 0.47 | 0.47 |
//! | 1/4 | 0.30 | 0.77 | 0.94 | 0.77 | 0.33 | 0.33 |
//! | 1/10 | 0.06 | 0.93 | 0.19 | 0.90 | 0.21 | 0.21 |
//! | 1/16 | 0.11 | 1.01 | 0.24 | 0.95 | 0.17 | 0.17 |
//!
//! A window in the middle of the set region does about the same (0.42, 1.09, 0.16, 0.26 below
//! ν = 0.5), a strip along one axis is better at 1/2 and 1/4 (0.32, 0.34) and far worse below
//! (0.64, 1.66).

/// The rank of a point: (max(dX, dY)/t)², in [0, 1). `side` is t, all in units of 2⁻⁶⁴.
///
/// Not decreasing in max(dX, dY); an index outside the set region has the greatest rank there is.
///
/// ```
/// use strew_core::{Pattern, sample::{rank, side_for}};
///
/// let pattern = Pattern::new("sqrt(3)".parse()?);
/// let side = pattern.alpha().set_side();
/// let quarter = side_for(0.25, side);
/// for x in -99..99 {
///     let (dx, dy) = pattern.index(x, 7 * x + 2);
///     assert_eq!(rank(dx, dy, side) < 0.25, dx < quarter && dy < quarter);
/// }
/// # Ok::<(), strew_core::pattern::AlphaError>(())
/// ```
#[must_use]
pub fn rank(index_x: u64, index_y: u64, side: u64) -> f64 {
    // Conversion, quotient and square all round monotonically.
    let part = index_x.max(index_y) as f64 / side as f64;
    (part * part).min(GREATEST)
}

/// The number before 1.
const GREATEST: f64 = 1.0 - f64::EPSILON / 2.0;

/// The side of the smaller set region that holds exactly the points of rank below `keep`, in units
/// of 2⁻⁶⁴: for all indices inside the set region of side `side`, [`rank`] < `keep` ⟺
/// max(dX, dY) < `side_for(keep, side)`.
///
/// The whole side from `keep` = 1 on; 0, which keeps nothing, up to `keep` = 0 and for NaN.
#[must_use]
pub fn side_for(keep: f64, side: u64) -> u64 {
    // A bisection on the rank itself: below `low` all are kept, from `high` on none.
    let (mut low, mut high) = (0, side);
    while low < high {
        let middle = low + (high - low) / 2;
        if rank(middle, middle, side) < keep {
            low = middle + 1
        } else {
            high = middle
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn any_side() -> impl Strategy<Value = u64> {
        prop_oneof![1u64 << 40..1 << 63, 1u64..100]
    }

    proptest! {
        #[test]
        fn the_side_keeps_what_the_rank_keeps(side in any_side(), keep in 0.0..1.1f64, at: u64) {
            let kept = side_for(keep, side);
            prop_assert!(kept <= side);
            // Anywhere, and next to the threshold.
            let near = (0..6).map(|i| kept.wrapping_add(i).wrapping_sub(3));
            for index in near.chain([at % side, 0, side - 1]).filter(|&i| i < side) {
                let value = rank(index, at % (index + 1), side);
                prop_assert!((0.0..1.0).contains(&value));
                prop_assert_eq!(value < keep, index < kept, "{} {}", index, kept);
            }
        }

        #[test]
        fn a_rank_is_its_own_threshold(side in any_side(), at: u64) {
            let index = at % side;
            let kept = side_for(rank(index, 0, side), side);
            prop_assert!(kept <= index);
            prop_assert!(kept == 0 || rank(kept - 1, 0, side) < rank(index, 0, side));
        }

        #[test]
        fn ranks_grow_with_the_index(side in any_side(), a: u64, b: u64) {
            let (a, b) = (a % side, b % side);
            prop_assert!(rank(a.min(b), 0, side) <= rank(0, a.max(b), side));
        }
    }

    #[test]
    fn the_ends_keep_nothing_and_all() {
        let side = 0x5123_4567_89ab_cdef;
        for keep in [0.0, -1.0, -0.0, f64::NAN] {
            assert_eq!(side_for(keep, side), 0);
        }
        for keep in [1.0, 1.5, f64::INFINITY] {
            assert_eq!(side_for(keep, side), side);
        }
        assert!(side_for(f64::MIN_POSITIVE, side) > 0);
    }
}
