//! The first step at which a rotation of the circle lands in an interval, in O(log).

/// The least i ≥ 0 with low ≤ (step·i mod m) ≤ high, for 0 ≤ low ≤ high < m.
///
/// Works like Euclid's algorithm: if no multiple of the step lands before the first wrap, the wraps
/// are multiples of m modulo the step, a smaller problem of the same form.
fn first_in_range(mut step: u128, m: u128, mut low: u128, mut high: u128) -> Option<u128> {
    step %= m;
    if low == 0 {
        return Some(0);
    }
    if step == 0 {
        return None;
    }
    if 2 * step > m {
        step = m - step;
        (low, high) = (m - high, m - low);
    }
    let i = low.div_ceil(step);
    if i * step <= high {
        return Some(i);
    }
    // step·i − m·wraps in [low, high]  ⇔  m·wraps mod step in [−high, −low] mod step.
    let wraps = first_in_range(
        m % step,
        step,
        (step - high % step) % step,
        (step - low % step) % step,
    )?;
    Some((low + m * wraps).div_ceil(step))
}

/// The least i ≥ 0 with (start + i·step) mod 2⁶⁴ < width, or `None` if there is none.
pub(super) fn first_hit(start: u64, step: u64, width: u64) -> Option<u64> {
    if start < width {
        return Some(0);
    }
    if width == 0 {
        return None;
    }
    let m = 1u128 << 64;
    let low = m - u128::from(start);
    let high = low + u128::from(width) - 1;
    first_in_range(step.into(), m, low, high).and_then(|i| u64::try_from(i).ok())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::pattern::floor_sum::count_hits;

    proptest! {
        #[test]
        fn is_the_first_and_a_hit(start: u64, step: u64, width in 1u64.., shrink in 0u32..40) {
            let width = (width >> shrink).max(1);
            if let Some(i) = first_hit(start, step, width) {
                prop_assert!(start.wrapping_add(i.wrapping_mul(step)) < width);
                prop_assert_eq!(count_hits(i, start, step, width), 0);
            } else {
                prop_assert_eq!(count_hits(u64::MAX, start, step, width), 0);
            }
        }

        #[test]
        fn agrees_with_search_for_small_steps(start: u64, step in 0u64..8, width in 1u64..50) {
            let (start, step) = (start << 58, step << 58);
            let brute = (0u64..70).find(|i| start.wrapping_add(i.wrapping_mul(step)) < width);
            prop_assert_eq!(first_hit(start, step, width), brute);
        }
    }
}
