//! Plain arithmetic in single precision, which is the same on all processors.
//!
//! Square roots are those of the processor's instruction, which round alike everywhere. The standard library has it, and
//! without it WebAssembly as one of its vectors.

#[cfg(all(target_arch = "wasm32", not(feature = "std")))]
use core::arch::wasm32::{
    f32x4_extract_lane, f32x4_splat, f32x4_sqrt, f64x2_extract_lane, f64x2_splat, f64x2_sqrt,
};

/// The length by which a move stays short of its limit, in units: more than rounding takes from the distance of two
/// points, before the step and in it.
pub(super) const SPARE: f32 = 2.0;

/// A factor for lengths: less than 1 by more than their rounding errors.
pub(super) const SURELY: f32 = 1.0 - 1.0 / 262_144.0;

/// A number within ±`most`.
#[inline(always)]
pub(super) fn within(v: f32, most: f32) -> f32 {
    let v = if v > most { most } else { v };
    if v < -most { -most } else { v }
}

/// 1.5 · 2²³: a number within ±2²², added to it, is rounded to an integer, in the lower bits.
pub(super) const ROUNDER: f32 = 12_582_912.0;

/// A push, to the nearest integer, plus the bits of the rounder.
#[inline(always)]
pub(super) fn rounded(push: f32) -> i32 {
    (push + ROUNDER).to_bits() as i32
}

/// The nearest integer; of two, the even one.
#[inline(always)]
pub(super) fn whole_number(v: f32) -> f32 {
    (v + ROUNDER) - ROUNDER
}

#[inline(always)]
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(super) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
pub(super) fn above_zero(v: f32) -> f32 {
    if v > 0.0 { v } else { 0.0 }
}

/// The sum of the squares of some numbers.
#[inline(always)]
pub(super) fn squares<const D: usize>(v: [f32; D]) -> f32 {
    let mut sum = v[0] * v[0];
    for v in &v[1..] {
        sum += v * v;
    }
    sum
}

/// The square root, which rounds alike everywhere.
pub(super) trait Root {
    fn sqrt_(self) -> Self;
}

impl Root for f32 {
    #[inline(always)]
    fn sqrt_(self) -> Self {
        self::sqrt_f32(self)
    }
}

#[cfg(feature = "std")]
#[inline(always)]
pub(super) fn sqrt(v: f64) -> f64 {
    v.sqrt()
}

#[cfg(feature = "std")]
#[inline(always)]
pub(super) fn sqrt_f32(v: f32) -> f32 {
    v.sqrt()
}

#[cfg(all(target_arch = "wasm32", not(feature = "std")))]
#[target_feature(enable = "simd128")]
pub(super) fn sqrt(v: f64) -> f64 {
    f64x2_extract_lane::<0>(f64x2_sqrt(f64x2_splat(v)))
}

#[cfg(all(target_arch = "wasm32", not(feature = "std")))]
#[target_feature(enable = "simd128")]
pub(super) fn sqrt_f32(v: f32) -> f32 {
    f32x4_extract_lane::<0>(f32x4_sqrt(f32x4_splat(v)))
}

#[cfg(not(any(target_arch = "wasm32", feature = "std")))]
pub(super) fn sqrt(v: f64) -> f64 {
    libm::sqrt(v)
}

#[cfg(not(any(target_arch = "wasm32", feature = "std")))]
pub(super) fn sqrt_f32(v: f32) -> f32 {
    libm::sqrtf(v)
}
