//! Functions and random numbers with the same bits on every machine, because they decide tables.
//!
//! They use +, −, ×, ÷ and √ on `f64` and `f32` in a fixed order. IEEE 754 defines these operations to the
//! last bit, and Rust neither contracts nor reorders them. Where speed does not matter, `libm`
//! serves as well: the pieces of a [curve](crate::curve) use its `pow`.
//!
//! Making a table spends most of its time in sums of exponentials over pairs. `libm`'s `exp` has
//! the same bits on every machine, too, but its branches keep these sums from being vectorized. The
//! last bits of the standard library's `exp` depend on the platform.

mod bessel;

pub use bessel::BesselJ0;

/// 1.5·2⁵²: its sum with a number of moderate size has the nearest integer in the low bits.
const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// ln 2 in two parts; the product of the first and an integer below 2¹¹ is exact.
const LN_2_HIGH: f64 = f64::from_bits(0x3fe6_2e42_fee0_0000);
const LN_2_LOW: f64 = f64::from_bits(0x3dea_39ef_3579_3c76);

/// Returns eˣ for −700 ≤ x ≤ 700, to about one unit in the last place. For other arguments the
/// result is arbitrary. Without branches and tables, so that loops over it vectorize.
#[inline]
pub fn exp(x: f64) -> f64 {
    // x = k·ln 2 + r with |r| ≤ ln 2 / 2; then the Taylor series of eʳ, and 2ᵏ from its bits.
    let shifted = x * core::f64::consts::LOG2_E + ROUNDER;
    let k = shifted - ROUNDER;
    let r = (x - k * LN_2_HIGH) - k * LN_2_LOW;
    let mut sum = 1.0 / 479_001_600.0;
    for c in [
        1.0 / 39_916_800.0,
        1.0 / 3_628_800.0,
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
        1.0,
        1.0,
    ] {
        sum = sum * r + c;
    }
    let power = f64::from_bits((shifted.to_bits() << 52).wrapping_add(1023 << 52));
    sum * power
}

/// eˣ in single precision for −80 ≤ x ≤ 80, within a relative error of 3·10⁻⁷.
#[inline(always)]
pub fn exp32(x: f32) -> f32 {
    /// 1.5·2²³: adding it rounds a small number to an integer in the lowest bits.
    const ROUNDER: f32 = 12_582_912.0;
    /// ln 2 in two parts; the first has few bits, so that products with small integers are exact.
    const LN_2_HIGH: f32 = 355.0 / 512.0;
    const LN_2_LOW: f32 = -2.121_944_4e-4;
    let shifted = x * core::f32::consts::LOG2_E + ROUNDER;
    let k = shifted - ROUNDER;
    let r = (x - k * LN_2_HIGH) - k * LN_2_LOW;
    let mut sum = 1.0 / 720.0;
    for c in [1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0] {
        sum = sum * r + c;
    }
    sum * f32::from_bits((shifted.to_bits() << 23).wrapping_add(127 << 23))
}

/// The generator `splitmix64` (Steele, Lea, Flood 2014). It is pinned, because it decides tables.
#[derive(Clone, Debug)]
pub struct SplitMix(u64);

impl SplitMix {
    /// The generator with this seed.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Returns the next 64 random bits.
    pub const fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns the next random number in [0, 1), a multiple of 2⁻⁵³.
    pub fn next_f64(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Returns independent places in a square, or cube, from 0 to `side`.
    pub fn places<const D: usize>(&mut self, count: usize, side: f64) -> Vec<[f64; D]> {
        let place = |_| std::array::from_fn(|_| self.next_f64() * side);
        (0..count).map(place).collect()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn agrees_with_the_standard_library(x in -700.0f64..700.0) {
            let expected = x.exp();
            prop_assert!((exp(x) - expected).abs() <= 4e-16 * expected, "{} {}", exp(x), expected);
        }

        #[test]
        fn single_precision_agrees_with_the_standard_library(x in -80.0f32..80.0) {
            let expected = f64::from(x).exp();
            prop_assert!((f64::from(exp32(x)) - expected).abs() <= 3e-7 * expected);
        }
    }

    #[test]
    fn its_bits_are_pinned() {
        // Each is within one unit in the last place of the true value.
        for (x, bits) in [
            (0.0, 0x3ff0_0000_0000_0000),
            (1.0, 0x4005_bf0a_8b14_576a),
            (-0.1, 0x3fec_f46d_99d5_2b3a),
            (-15.125, 0x3e92_1dd7_2e8b_8a28),
            (-300.0, 0x24e2_4563_9c3a_49f7_u64),
        ] {
            assert_eq!(exp(x).to_bits(), bits, "{x}: {:#x}", exp(x).to_bits());
        }
    }

    #[test]
    fn the_generator_is_the_published_one() {
        // Reference values of splitmix64 for the seed 1234567.
        let mut random = SplitMix::new(1_234_567);
        assert_eq!(random.next_u64(), 6_457_827_717_110_365_317);
        assert_eq!(random.next_u64(), 3_203_168_211_198_807_973);
    }
}
