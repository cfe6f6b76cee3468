//! Plain loops, compiled for the machine at hand. Those over hashed numbers gain most: their 64-bit
//! products are single instructions there, where plain vectors take a dozen for each.

use super::Backend;

/// Writes numbers one after another; there are as many as `out` has room for.
pub(in crate::sample) fn write(numbers: impl Iterator<Item = f64>, out: &mut [f64]) {
    run(Backend::best(), || {
        for (out, number) in out.iter_mut().zip(numbers) {
            *out = number;
        }
    });
}

/// Runs a loop.
#[inline]
pub(in crate::sample) fn run<T>(backend: Backend, work: impl FnOnce() -> T) -> T {
    match backend {
        // SAFETY: `Backend::available` has found the instructions.
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        Backend::Avx512 => unsafe { run_wide(work) },
        _ => work(),
    }
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
fn run_wide<T>(work: impl FnOnce() -> T) -> T {
    work()
}
