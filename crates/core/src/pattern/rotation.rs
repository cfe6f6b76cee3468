//! Rotations of the circle: how many steps land in an interval and which is the first, in O(log), and sums of whole turns
//! of the index over a range of coordinates.
//!
//! The number of indices between two thresholds is a difference of such sums. The thresholds of a map
//! are neighbor shifts −(αk + b)/2, and shifting a threshold by k is shifting the range by k. So four
//! sums in closed form, corrected at both ends of the range for each k, count all intervals at once.

use alloc::vec::Vec;
use core::ops::Range;

use super::Alpha;

/// Σ ⌊(a·i + b)/2⁶⁴⌋ for 0 ≤ i < n, modulo 2¹²⁸.
///
/// The recursion on (a, 2⁶⁴) of Graham, Knuth, Patashnik, *Concrete Mathematics*, §3.5: about 92
/// rounds of one division at most.
pub(super) fn floor_sum(n: u64, a: u64, b: u128) -> u128 {
    let (mut n, mut a, mut b) = (u128::from(n), u128::from(a), b);
    let mut m = 1u128 << 64;
    let mut sum = 0u128;
    if n == 0 {
        return 0;
    }
    loop {
        if a >= m {
            // n ≤ 2⁶⁴, so n·(n − 1) fits once the even factor is halved.
            let pairs = if n % 2 == 0 {
                (n / 2) * (n - 1)
            } else {
                n * ((n - 1) / 2)
            };
            sum = sum.wrapping_add(pairs.wrapping_mul(a / m));
            a %= m;
        }
        if b >= m {
            sum = sum.wrapping_add(n.wrapping_mul(b / m));
            b %= m;
        }
        // a, b < m ≤ 2⁶⁴ and n < 2⁶⁴: no overflow.
        let top = a * n + b;
        if top < m {
            return sum;
        }
        n = top / m;
        b = top % m;
        (m, a) = (a, m);
    }
}

/// The number of i in 0..n with (start + i·step) mod 2⁶⁴ < width.
pub(super) fn count_hits(n: u64, start: u64, step: u64, width: u64) -> u64 {
    // [v mod M < w] = 1 + ⌊v/M⌋ − ⌊(v + M − w)/M⌋ for 0 ≤ w ≤ M.
    let start = u128::from(start);
    let shifted = start + (1 << 64) - u128::from(width);
    let hits = u128::from(n)
        .wrapping_add(floor_sum(n, step, start))
        .wrapping_sub(floor_sum(n, step, shifted));
    hits as u64
}

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

/// The sums Σ ⌊(α·v + b)/2 + origin⌋ modulo 2⁶⁴ over a range moved by k, for each k of a range of
/// shifts, by b and the parity of v.
#[derive(Clone, Debug)]
pub(crate) struct Turns {
    least: i64,
    sums: Vec<[[u64; 2]; 2]>,
}

impl Turns {
    /// Sums over `range`, moved by each of `shifts`, for the origin `zero` in units of 2⁻⁶⁴.
    pub(crate) fn new(alpha: Alpha, zero: u64, range: &Range<i64>, shifts: Range<i64>) -> Self {
        let half = alpha.half();
        // ⌊(α·v + b)/2 + origin⌋ as a whole number.
        let at = |v: i64, b: u8| {
            let value = i128::from(half) * i128::from(v) + i128::from(zero);
            value + (i128::from(b) << 63)
        };
        let turns = |v: i64, b: u8| (at(v, b) >> 64) as u64;
        let (mut start, mut end) = (range.start + shifts.start, range.end + shifts.start);
        let mut now = [[0u64; 2]; 2];
        for (b, now) in (0u8..).zip(&mut now) {
            for (parity, now) in now.iter_mut().enumerate() {
                let first = start + ((start ^ parity as i64) & 1);
                let n = (end - first).max(0) as u64;
                let n = n.div_ceil(2);
                let from = at(first, b);
                // A step of two coordinates is α: one turn and this.
                let step = half.wrapping_mul(2);
                let pairs = if n.is_multiple_of(2) {
                    (n / 2).wrapping_mul(n.wrapping_sub(1))
                } else {
                    n.wrapping_mul((n - 1) / 2)
                };
                let whole = n.wrapping_mul((from >> 64) as u64).wrapping_add(pairs);
                let rest = floor_sum(n, step, u128::from(from as u64)) as u64;
                *now = whole.wrapping_add(rest);
            }
        }
        let mut sums = Vec::with_capacity((shifts.end - shifts.start).max(0) as usize);
        for _ in shifts.clone() {
            sums.push(now);
            for (b, now) in (0u8..).zip(&mut now) {
                let (out, into) = ((start & 1) as usize, (end & 1) as usize);
                now[out] = now[out].wrapping_sub(turns(start, b));
                now[into] = now[into].wrapping_add(turns(end, b));
            }
            start += 1;
            end += 1;
        }
        Self {
            least: shifts.start,
            sums,
        }
    }

    /// The sum for one shift, over the coordinates whose parity was `parity` before it.
    pub(crate) fn sum(&self, shift: i64, b: u8, parity: u8) -> u64 {
        let sums = &self.sums[(shift - self.least) as usize];
        sums[usize::from(b & 1)][((i64::from(parity) + shift) & 1) as usize]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn agrees_with_counting(n in 0u64..400, start: u64, step: u64, width: u64) {
            let brute = (0..n).filter(|i| start.wrapping_add(i.wrapping_mul(step)) < width).count();
            prop_assert_eq!(count_hits(n, start, step, width), brute as u64);
        }

        #[test]
        fn long_ranges_are_the_sum_of_their_parts(
            n: u64, part: u64, start: u64, step: u64, width: u64,
        ) {
            let part = part.min(n);
            let second = start.wrapping_add(part.wrapping_mul(step));
            prop_assert_eq!(
                count_hits(n, start, step, width),
                count_hits(part, start, step, width) + count_hits(n - part, second, step, width)
            );
        }
    }

    #[test]
    fn ends_of_the_ranges() {
        assert_eq!(count_hits(u64::MAX, 0, 1, 7), 7);
        assert_eq!(count_hits(u64::MAX, 0, 0, 1), u64::MAX);
        assert_eq!(count_hits(0, 5, 5, 5), 0);
        assert_eq!(count_hits(9, 5, 5, 0), 0);
    }

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
