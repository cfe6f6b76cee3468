//! Arrangements: which finite sets of offsets occur in a pattern, and how often.

use super::{Alpha, Pattern};

/// The frequency of an arrangement: the share of pattern points p for which p + o belongs to the
/// pattern for every offset o. It is 0 iff the arrangement never occurs.
///
/// An arrangement occurs iff the image of its offsets in index space fits the set region. Its frequency
/// is the area of the margin that is left, over the area t² of the set region. The offset (0, 0) is
/// implied.
///
/// ```
/// use strew_core::pattern::arrangement_frequency;
///
/// let alpha = "sqrt(3)".parse()?;
/// assert_eq!(arrangement_frequency(alpha, &[]), 1.0);
/// assert_eq!(arrangement_frequency(alpha, &[(1, 0)]), 0.0);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn arrangement_frequency(alpha: Alpha, offsets: &[(i64, i64)]) -> f64 {
    let pattern = Pattern::new(alpha);
    let side = alpha.set_side_f64();
    let mut low = (0.0f64, 0.0f64);
    let mut high = (0.0f64, 0.0f64);
    for &(i, j) in offsets {
        let (dx, dy) = pattern.index(i, j);
        // Taken with a sign: a shift beyond ±t never fits.
        let unit = 1.0 / 18_446_744_073_709_551_616.0;
        let (dx, dy) = (dx as i64 as f64 * unit, dy as i64 as f64 * unit);
        low = (low.0.min(dx), low.1.min(dy));
        high = (high.0.max(dx), high.1.max(dy));
    }
    let margin = |low: f64, high: f64| (side - (high - low)).max(0.0) / side;
    margin(low.0, high.0) * margin(low.1, high.1)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]
        #[test]
        fn frequency_is_the_share_of_points_that_show_it(
            offsets in proptest::collection::vec((-8i64..=8, -8i64..=8), 1..3),
        ) {
            let alpha: Alpha = "(5-sqrt(3))/2".parse().expect("valid");
            let pattern = Pattern::new(alpha);
            let (mut points, mut shown) = (0u32, 0u32);
            for y in -200..200i64 {
                for x in -200..200i64 {
                    if pattern.contains(x, y) {
                        points += 1;
                        shown += u32::from(offsets.iter().all(|&(i, j)| pattern.contains(x + i, y + j)));
                    }
                }
            }
            let found = f64::from(shown) / f64::from(points);
            prop_assert!((found - arrangement_frequency(alpha, &offsets)).abs() < 0.02);
        }
    }
}
