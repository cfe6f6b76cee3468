//! The number of times that a rotation of the circle lands in an interval, in O(log).

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
}
