//! A single-precision exponential that vectorizes.

/// 1.5·2²³: adding it rounds a small number to an integer in the lowest bits.
const ROUNDER: f32 = 12_582_912.0;
/// ln 2 in two parts; the first has few bits, so that products with small integers are exact.
const LN_2_HIGH: f32 = 355.0 / 512.0;
const LN_2_LOW: f32 = -2.121_944_4e-4;

/// eˣ for −80 ≤ x ≤ 80, within a relative error of 3·10⁻⁷.
#[inline(always)]
#[must_use]
pub fn exp32(x: f32) -> f32 {
    let shifted = x * core::f32::consts::LOG2_E + ROUNDER;
    let k = shifted - ROUNDER;
    let r = (x - k * LN_2_HIGH) - k * LN_2_LOW;
    let mut sum = 1.0 / 720.0;
    for c in [1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0] {
        sum = sum * r + c;
    }
    sum * f32::from_bits((shifted.to_bits() << 23).wrapping_add(127 << 23))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn agrees_with_the_standard_library(x in -80.0f32..80.0) {
            let expected = f64::from(x).exp();
            prop_assert!((f64::from(exp32(x)) - expected).abs() <= 3e-7 * expected);
        }
    }
}
