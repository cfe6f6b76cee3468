//! Ranks: an order in which points leave when a set is thinned.
//!
//! The rank of a point is (depth/t)². Its [depth](crate::Pattern::depth) is the distance of its index
//! from a corner of the set region, along the axis where that is larger. The index is uniform over the
//! set region, so the rank is uniform over the pattern, and the points of rank below λ are those of a
//! smaller set region of side t·√λ. They nest as λ grows, form four products again, and keep every
//! closed-form count. Integers decide: [`side_for`] returns the side at which comparing depths and
//! comparing ranks agree to the bit.
//!
//! The corner depends on the class: in odd rows dX is measured from its upper end, in odd columns dY.
//! What remains is more even than a random choice, which leaves power 1 − λ, but neighbors come as near
//! as with a random choice. Mean power below ν = 0.5 of the blue table with 63 intervals, in units of the
//! thinned set:
//!
//! | λ | random | this | one corner | the center | a strip along one axis |
//! |---|---|---|---|---|---|
//! | 3/4 | 0.25 | 0.23 | 0.23 | | |
//! | 1/2 | 0.50 | 0.36 | 0.50 | 0.42 | 0.32 |
//! | 1/4 | 0.75 | 0.34 | 0.92 | 1.09 | 0.34 |
//! | 1/10 | 0.90 | 0.20 | 0.20 | 0.16 | 0.64 |
//! | 1/16 | 0.94 | 0.26 | 0.22 | 0.26 | 1.66 |
//!
//! Of the 64 ways to give each class a corner this one has the best sum over these λ. δ_min of the rest
//! is δ_min·√λ of the full set, as with a random choice: some pair of neighbors always stays.

/// The rank of a point of a [depth](crate::Pattern::depth): (depth/t)², in [0, 1). `side` is t; both are
/// in units of 2⁻⁶⁴.
///
/// The rank never falls as the depth grows. A depth of t or more, which no point of the pattern has,
/// has the greatest rank, 1 − 2⁻⁵³.
///
/// ```
/// use strew_core::{Pattern, rank, side_for};
///
/// let pattern = Pattern::new("sqrt(3)".parse()?);
/// let side = pattern.alpha().set_side();
/// let quarter = pattern.thinned(side_for(0.25, side));
/// for x in -99..99 {
///     let y = 7 * x + 2;
///     assert_eq!(quarter.contains(x, y), rank(pattern.depth(x, y), side) < 0.25);
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn rank(depth: u64, side: u64) -> f64 {
    // Conversion, quotient and square all round monotonically.
    let part = depth as f64 / side as f64;
    (part * part).min(GREATEST)
}

/// The largest number below 1.
const GREATEST: f64 = 1.0 - f64::EPSILON / 2.0;

/// The side of the set region that holds exactly the points of rank below `keep`, in units of 2⁻⁶⁴: for
/// all depths below `side`, [`rank`] < `keep` ⟺ depth < `side_for(keep, side)`.
///
/// It is the whole side for `keep` ≥ 1, and 0, which keeps nothing, for `keep` ≤ 0 and NaN.
///
/// ```
/// use strew_core::{rank, side_for};
///
/// let t = 1 << 62;
/// // Ranks go as the square of the depth: up to half of the side they are below a quarter.
/// assert_eq!(rank(t / 2, t), 0.25);
/// let side = side_for(0.25, t);
/// assert!(rank(side - 1, t) < 0.25 && rank(side, t) >= 0.25);
/// ```
#[must_use]
pub fn side_for(keep: f64, side: u64) -> u64 {
    if keep >= 1.0 {
        return side;
    }
    // A bisection on the rank itself: below `low` all are kept, at `high` and above none.
    let (mut low, mut high) = (0, side);
    while low < high {
        let middle = low + (high - low) / 2;
        if rank(middle, side) < keep {
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
                let value = rank(index, side);
                prop_assert!((0.0..1.0).contains(&value));
                prop_assert_eq!(value < keep, index < kept, "{} {}", index, kept);
            }
        }

        #[test]
        fn a_rank_is_its_own_threshold(side in any_side(), at: u64) {
            let index = at % side;
            let kept = side_for(rank(index, side), side);
            prop_assert!(kept <= index);
            prop_assert!(kept == 0 || rank(kept - 1, side) < rank(index, side));
        }

        #[test]
        fn ranks_grow_with_the_depth(side in any_side(), a: u64, b: u64) {
            let (a, b) = (a % side, b % side);
            prop_assert!(rank(a.min(b), side) <= rank(a.max(b), side));
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
