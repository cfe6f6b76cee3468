//! Rows by 256-bit vectors: the same operations in the same order as the definition. What is left
//! at the end of a row is done by the definition itself.

use core::arch::x86_64::*;

use super::{Format, Row, shear::Columns};
use crate::sample::warp::{CELL_BITS, PATCH_CELL_MASK, PATCH_CELLS, PatchShears};

/// Eight entries of a table, by the lowest four bits of their index.
#[inline]
#[target_feature(enable = "avx2")]
fn pick(table: &[f32; PATCH_CELLS], index: __m256i) -> __m256 {
    // SAFETY: the table has sixteen entries.
    let (low, high) = unsafe {
        (
            _mm256_loadu_ps(table.as_ptr()),
            _mm256_loadu_ps(table.as_ptr().add(8)),
        )
    };
    // The fourth bit of the index, as the sign, chooses the half.
    let half = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(index));
    _mm256_blendv_ps(
        _mm256_permutevar8x32_ps(low, index),
        _mm256_permutevar8x32_ps(high, index),
        half,
    )
}

/// g of eight coordinates across a direction; see [`PatchShears`].
#[inline]
#[target_feature(enable = "avx2")]
fn noise(shears: &PatchShears, direction: usize, s: __m256i) -> __m256i {
    let cell = _mm256_srai_epi32::<{ CELL_BITS as i32 }>(s);
    let at = _mm256_and_si256(s, _mm256_set1_epi32(PATCH_CELL_MASK));
    let unit = _mm256_set1_ps(1.0 / (1u32 << CELL_BITS) as f32);
    let u = _mm256_mul_ps(_mm256_cvtepi32_ps(at), unit);
    let table = &shears.cubics[direction];
    let mut value = pick(&table[3], cell);
    for power in [2, 1, 0] {
        value = _mm256_add_ps(_mm256_mul_ps(value, u), pick(&table[power], cell));
    }
    _mm256_cvttps_epi32(value)
}

/// Eight warped positions; see [`PatchShears::apply`].
#[inline]
#[target_feature(enable = "avx2")]
fn warp(shears: &PatchShears, x: __m256i, y: __m256i) -> (__m256i, __m256i) {
    let x = _mm256_add_epi32(x, noise(shears, 0, y));
    let y = _mm256_add_epi32(y, noise(shears, 1, x));
    let rising = noise(shears, 2, _mm256_sub_epi32(x, y));
    let (x, y) = (_mm256_add_epi32(x, rising), _mm256_add_epi32(y, rising));
    let falling = noise(shears, 3, _mm256_add_epi32(x, y));
    (_mm256_add_epi32(x, falling), _mm256_sub_epi32(y, falling))
}

/// As many of a warped row's points as fill whole vectors; gives how many.
#[target_feature(enable = "avx2")]
pub(super) fn warped_row<F: Format>(
    format: &F,
    shears: &PatchShears,
    row: Row,
    columns: Columns<'_>,
    out: &mut [F::Item],
) -> usize {
    let whole = out.len() & !7;
    let ys = _mm256_set1_epi32(row.y);
    for start in (0..whole).step_by(8) {
        let (mut x, mut y) = ([0i32; 8], [0i32; 8]);
        let displaced = &columns.displaced[start..start + 8];
        let displacements = &columns.displacements[start..start + 8];
        // SAFETY: all four hold eight values.
        unsafe {
            let from = _mm256_loadu_si256(displaced.as_ptr().cast());
            let dy = _mm256_loadu_si256(displacements.as_ptr().cast());
            let (to_x, to_y) = warp(shears, from, _mm256_add_epi32(dy, ys));
            _mm256_storeu_si256(x.as_mut_ptr().cast(), to_x);
            _mm256_storeu_si256(y.as_mut_ptr().cast(), to_y);
        }
        let lattice = &columns.lattice[start..start + 8];
        for (i, out) in out[start..start + 8].iter_mut().enumerate() {
            let column = format.column(row.base, x[i], lattice[i]);
            *out = format.item(row.base, column, y[i], row.lattice);
        }
    }
    whole
}

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
