//! Loops over hashed numbers, compiled for the machine at hand: their 64-bit products are single
//! instructions there, where plain vectors take a dozen for each.

use super::Backend;

/// Writes numbers one after another; there are as many as `out` has room for.
pub(in crate::sample) fn write(numbers: impl Iterator<Item = f64>, out: &mut [f64]) {
    match Backend::best() {
        // SAFETY: `Backend::best` has found the instructions.
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        Backend::Avx512 => unsafe { write_wide(numbers, out) },
        _ => write_plain(numbers, out),
    }
}

#[inline(always)]
fn write_plain(numbers: impl Iterator<Item = f64>, out: &mut [f64]) {
    for (out, number) in out.iter_mut().zip(numbers) {
        *out = number;
    }
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
fn write_wide(numbers: impl Iterator<Item = f64>, out: &mut [f64]) {
    write_plain(numbers, out);
}
