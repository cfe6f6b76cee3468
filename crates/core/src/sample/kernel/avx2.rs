//! Rows by 256-bit vectors: the same operations in the same order as the definition. What is left
//! at the end of a row is done by the definition itself.

use core::arch::x86_64::*;

/// As many of a row's `f32` pairs as fill whole vectors; gives how many. See [`F32`](super::F32).
#[target_feature(enable = "avx2")]
pub(super) fn f32_row(
    (base, step, last): (f64, f64, f32),
    y: i32,
    columns: &[f32],
    displacements: &[i32],
    out: &mut [[f32; 2]],
) -> usize {
    let length = out.len().min(columns.len()).min(displacements.len()) & !7;
    let (bases, steps) = (_mm256_set1_pd(base), _mm256_set1_pd(step));
    let (lasts, ys) = (_mm256_set1_ps(last), _mm256_set1_epi32(y));
    let mut i = 0;
    while i < length {
        // SAFETY: i + 8 ≤ `length`, which is at most the length of each slice.
        unsafe {
            let displacement = _mm256_loadu_si256(displacements.as_ptr().add(i).cast());
            let offset = _mm256_add_epi32(displacement, ys);
            let low = _mm256_cvtepi32_pd(_mm256_castsi256_si128(offset));
            let high = _mm256_cvtepi32_pd(_mm256_extracti128_si256::<1>(offset));
            let low = _mm256_cvtpd_ps(_mm256_mul_pd(_mm256_add_pd(bases, low), steps));
            let high = _mm256_cvtpd_ps(_mm256_mul_pd(_mm256_add_pd(bases, high), steps));
            let place = _mm256_min_ps(_mm256_set_m128(high, low), lasts);
            let column = _mm256_loadu_ps(columns.as_ptr().add(i));
            // Pairs 0 1 4 5 and 2 3 6 7.
            let even = _mm256_unpacklo_ps(column, place);
            let odd = _mm256_unpackhi_ps(column, place);
            let to: *mut f32 = out.as_mut_ptr().add(i).cast();
            _mm256_storeu_ps(to, _mm256_permute2f128_ps::<0x20>(even, odd));
            _mm256_storeu_ps(to.add(8), _mm256_permute2f128_ps::<0x31>(even, odd));
        }
        i += 8;
    }
    length
}

/// As many of a row's `f64` pairs as fill whole vectors; gives how many. See [`F64`](super::F64).
#[target_feature(enable = "avx2")]
pub(super) fn f64_row(
    (base, step): (f64, f64),
    y: i32,
    columns: &[f64],
    displacements: &[i32],
    out: &mut [[f64; 2]],
) -> usize {
    let length = out.len().min(columns.len()).min(displacements.len()) & !3;
    let (bases, steps) = (_mm256_set1_pd(base), _mm256_set1_pd(step));
    let ys = _mm_set1_epi32(y);
    let mut i = 0;
    while i < length {
        // SAFETY: i + 4 ≤ `length`, which is at most the length of each slice.
        unsafe {
            let displacement = _mm_loadu_si128(displacements.as_ptr().add(i).cast());
            let offset = _mm256_cvtepi32_pd(_mm_add_epi32(displacement, ys));
            let place = _mm256_mul_pd(_mm256_add_pd(bases, offset), steps);
            let column = _mm256_loadu_pd(columns.as_ptr().add(i));
            // Pairs 0 2 and 1 3.
            let even = _mm256_unpacklo_pd(column, place);
            let odd = _mm256_unpackhi_pd(column, place);
            let to: *mut f64 = out.as_mut_ptr().add(i).cast();
            _mm256_storeu_pd(to, _mm256_permute2f128_pd::<0x20>(even, odd));
            _mm256_storeu_pd(to.add(4), _mm256_permute2f128_pd::<0x31>(even, odd));
        }
        i += 4;
    }
    length
}
