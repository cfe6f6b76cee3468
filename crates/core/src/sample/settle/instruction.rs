//! Square roots by the instruction of the processor. They round alike everywhere.
//!
//! The standard library has it, and without it WebAssembly as one of its vectors.

#[cfg(all(target_arch = "wasm32", not(feature = "std")))]
use core::arch::wasm32::{
    f32x4_extract_lane, f32x4_splat, f32x4_sqrt, f64x2_extract_lane, f64x2_splat, f64x2_sqrt,
};

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
