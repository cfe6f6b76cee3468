//! Running a loop by a backend.

use super::{
    Backend, arch,
    lanes::{PlainLoop, VectorLoop},
};

/// Runs a vector loop by a backend. Returns the number of items written; the caller's plain code writes
/// the rest.
#[inline]
pub(super) fn run_vectors(backend: Backend, work: &mut impl VectorLoop) -> usize {
    let _ = &work;
    match backend {
        Backend::Scalar => 0,
        // SAFETY: `Backend::available` has found the instructions.
        #[cfg(target_arch = "x86_64")]
        Backend::Avx2 => unsafe { arch::avx2::run(work) },
        #[cfg(target_arch = "x86_64")]
        Backend::Avx512 => {
            // SAFETY: `Backend::available` has found the instructions.
            let written = unsafe { arch::avx512::run(work) };
            if written > 0 {
                return written;
            }
            // Rows too short for 512 bits. SAFETY: as above; this backend includes AVX2.
            unsafe { arch::avx2::run(work) }
        }
        // SAFETY: the program is compiled for machines with the instructions.
        #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
        Backend::Neon => unsafe { arch::neon::run(work) },
        // SAFETY: the program is compiled for machines with the instructions.
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        Backend::Simd128 => unsafe { arch::simd128::run(work) },
    }
}

/// Runs plain code that is compiled for the backend's instructions. Hashed numbers profit most: their
/// 64-bit products are single AVX-512 instructions, and a dozen for half as many numbers without AVX2.
#[inline]
pub(crate) fn compiled<T>(backend: Backend, work: impl FnOnce() -> T) -> T {
    match backend {
        // SAFETY: `Backend::available` has found the instructions.
        #[cfg(target_arch = "x86_64")]
        Backend::Avx512 => unsafe { arch::avx512::compiled(work) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Backend::Avx2 => unsafe { arch::avx2::compiled(work) },
        _ => work(),
    }
}

/// Runs a loop that is compiled for the backend's instructions.
#[inline]
pub(crate) fn compiled_loop(backend: Backend, work: &mut impl PlainLoop) {
    match backend {
        // SAFETY: `Backend::available` has found the instructions.
        #[cfg(target_arch = "x86_64")]
        Backend::Avx512 => unsafe { arch::avx512::compiled_loop(work) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Backend::Avx2 => unsafe { arch::avx2::compiled_loop(work) },
        _ => work.run(),
    }
}

/// Writes numbers one after another, as many as `out` has room for.
pub(crate) fn write_numbers(numbers: impl Iterator<Item = f64>, out: &mut [f64]) {
    compiled(Backend::best(), || {
        for (out, number) in out.iter_mut().zip(numbers) {
            *out = number;
        }
    });
}
