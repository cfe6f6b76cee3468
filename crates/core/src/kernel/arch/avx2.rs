//! 256-bit vectors of x86-64: eight lanes.

use core::arch::x86_64::*;

use crate::{
    kernel::lanes::{Lanes, PlainLoop, VectorLoop},
    table::FRACTION_BITS,
    warp::{CELL_BITS, PatchShears},
};

entries!(Avx2, "avx2,popcnt");

pub(in crate::kernel) struct Avx2;

impl Lanes for Avx2 {
    const WIDTH: usize = 8;
    const WINDOW: usize = 8;
    const HAS_COMPRESS: bool = true;

    type Ints = __m256i;
    type Singles = __m256;
    type Doubles = [__m256d; 2];
    type Table = __m256;

    operations! {
        load_ints(from: *const i32) -> Self::Ints = _mm256_loadu_si256(from.cast());
        splat_int(v: i32) -> Self::Ints = _mm256_set1_epi32(v);
        add_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = _mm256_add_epi32(a, b);
        sub_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = _mm256_sub_epi32(a, b);
        min_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = _mm256_min_epi32(a, b);
        max_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = _mm256_max_epi32(a, b);
        fixed(v: Self::Ints) -> Self::Ints = _mm256_slli_epi32::<{ FRACTION_BITS as i32 }>(v);
        cells(v: Self::Ints) -> Self::Ints = _mm256_srai_epi32::<{ CELL_BITS as i32 }>(v);
        places(v: Self::Ints) -> Self::Ints =
            _mm256_and_si256(v, _mm256_set1_epi32(PatchShears::CELL_MASK));
        load_singles(from: *const f32) -> Self::Singles = _mm256_loadu_ps(from);
        splat_single(v: f32) -> Self::Singles = _mm256_set1_ps(v);
        add_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = _mm256_add_ps(a, b);
        mul_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = _mm256_mul_ps(a, b);
        min_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = _mm256_min_ps(a, b);
        singles_of(v: Self::Ints) -> Self::Singles = _mm256_cvtepi32_ps(v);
        truncate(v: Self::Singles) -> Self::Ints = _mm256_cvttps_epi32(v);
        table(from: *const f32) -> Self::Table = _mm256_loadu_ps(from);
        pick(table: Self::Table, places: Self::Ints) -> Self::Singles =
            _mm256_permutevar8x32_ps(table, places);
        gather(from: *const f32, places: Self::Ints) -> Self::Singles =
            _mm256_i32gather_ps::<4>(from, places);
        bits_of(v: Self::Singles) -> Self::Ints = _mm256_castps_si256(v);
        load_doubles(from: *const f64) -> Self::Doubles =
            [_mm256_loadu_pd(from), _mm256_loadu_pd(from.add(4))];
        splat_double(v: f64) -> Self::Doubles = [_mm256_set1_pd(v); 2];
        add_doubles(a: Self::Doubles, b: Self::Doubles) -> Self::Doubles =
            [_mm256_add_pd(a[0], b[0]), _mm256_add_pd(a[1], b[1])];
        mul_doubles(a: Self::Doubles, b: Self::Doubles) -> Self::Doubles =
            [_mm256_mul_pd(a[0], b[0]), _mm256_mul_pd(a[1], b[1])];
        offsets(from: *const i32, y: i32) -> Self::Doubles =
            Self::doubles_of(Self::add_ints(Self::load_ints(from), Self::splat_int(y)));
        store_ints(to: *mut i32, v: Self::Ints) = _mm256_storeu_si256(to.cast(), v);
    }

    #[inline(always)]
    unsafe fn pick_at_once(from: *const f32, places: __m256i) -> __m256 {
        unsafe {
            let low = _mm256_permutevar8x32_ps(_mm256_loadu_ps(from), places);
            let high = _mm256_permutevar8x32_ps(_mm256_loadu_ps(from.add(8)), places);
            // The fourth bit as the sign.
            let is_high = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(places));
            _mm256_blendv_ps(low, high, is_high)
        }
    }

    #[inline(always)]
    unsafe fn doubles_of(v: __m256i) -> [__m256d; 2] {
        unsafe {
            let low = _mm256_cvtepi32_pd(_mm256_castsi256_si128(v));
            let high = _mm256_cvtepi32_pd(_mm256_extracti128_si256::<1>(v));
            [low, high]
        }
    }

    #[inline(always)]
    unsafe fn narrow([low, high]: [__m256d; 2]) -> __m256 {
        unsafe { _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low)) }
    }

    #[inline(always)]
    unsafe fn between(v: __m256i, least: i32, end: i32) -> u32 {
        unsafe {
            let below = _mm256_cmpgt_epi32(_mm256_set1_epi32(least), v);
            let is_inside =
                _mm256_andnot_si256(below, _mm256_cmpgt_epi32(_mm256_set1_epi32(end), v));
            _mm256_movemask_ps(_mm256_castsi256_ps(is_inside)) as u32
        }
    }

    #[inline(always)]
    unsafe fn compress(v: __m256i, mask: u32) -> __m256i {
        /// The numbers of the lanes of each mask, one after another.
        static LANES: [[u8; 8]; 256] = {
            let mut all = [[0; 8]; 256];
            let mut mask = 0;
            while mask < 256 {
                let (mut kept, mut lane) = (0, 0);
                while lane < 8 {
                    if mask >> lane & 1 == 1 {
                        all[mask][kept] = lane as u8;
                        kept += 1;
                    }
                    lane += 1;
                }
                mask += 1;
            }
            all
        };
        unsafe {
            let lanes = _mm_loadl_epi64(LANES[mask as usize & 255].as_ptr().cast());
            _mm256_permutevar8x32_epi32(v, _mm256_cvtepu8_epi32(lanes))
        }
    }

    #[inline(always)]
    unsafe fn store_single_pairs(to: *mut [f32; 2], x: __m256, y: __m256) {
        unsafe {
            // Pairs 0 1 4 5 and 2 3 6 7.
            let even = _mm256_unpacklo_ps(x, y);
            let odd = _mm256_unpackhi_ps(x, y);
            let to: *mut f32 = to.cast();
            _mm256_storeu_ps(to, _mm256_permute2f128_ps::<0x20>(even, odd));
            _mm256_storeu_ps(to.add(8), _mm256_permute2f128_ps::<0x31>(even, odd));
        }
    }

    #[inline(always)]
    unsafe fn store_double_pairs(to: *mut [f64; 2], x: [__m256d; 2], y: [__m256d; 2]) {
        unsafe {
            let to: *mut f64 = to.cast();
            for half in 0..2 {
                // Pairs 0 2 and 1 3.
                let even = _mm256_unpacklo_pd(x[half], y[half]);
                let odd = _mm256_unpackhi_pd(x[half], y[half]);
                let to = to.add(8 * half);
                _mm256_storeu_pd(to, _mm256_permute2f128_pd::<0x20>(even, odd));
                _mm256_storeu_pd(to.add(4), _mm256_permute2f128_pd::<0x31>(even, odd));
            }
        }
    }

    #[inline(always)]
    unsafe fn store_single_places(
        to: *mut [f32; 2],
        offsets: [__m256i; 2],
        (base, step, [last_x, last_y]): ([f64; 2], f64, [f32; 2]),
    ) {
        unsafe {
            let last = _mm_setr_ps(last_x, last_y, last_x, last_y);
            let (places, to) = (places(offsets, base, step), to.cast::<f32>());
            for (pair, place) in places.into_iter().enumerate() {
                _mm_storeu_ps(to.add(4 * pair), _mm_min_ps(_mm256_cvtpd_ps(place), last));
            }
        }
    }

    #[inline(always)]
    unsafe fn store_double_places(
        to: *mut [f64; 2],
        offsets: [__m256i; 2],
        (base, step): ([f64; 2], f64),
    ) {
        unsafe {
            let (places, to) = (places(offsets, base, step), to.cast::<f64>());
            for (pair, place) in places.into_iter().enumerate() {
                _mm256_storeu_pd(to.add(4 * pair), place);
            }
        }
    }
}

/// (base + offset)·step, x and y side by side, two points a vector. Offsets are paired before they are
/// converted, which takes fewer operations than afterwards.
///
/// # Safety
/// The machine has AVX2.
#[inline(always)]
unsafe fn places([x, y]: [__m256i; 2], base: [f64; 2], step: f64) -> [__m256d; 4] {
    unsafe {
        // Pairs 0 1 4 5 and 2 3 6 7.
        let (even, odd) = (_mm256_unpacklo_epi32(x, y), _mm256_unpackhi_epi32(x, y));
        let base = _mm256_setr_pd(base[0], base[1], base[0], base[1]);
        let step = _mm256_set1_pd(step);
        let mut places = [step; 4];
        for (place, pairs) in places.iter_mut().zip([
            _mm256_castsi256_si128(even),
            _mm256_castsi256_si128(odd),
            _mm256_extracti128_si256::<1>(even),
            _mm256_extracti128_si256::<1>(odd),
        ]) {
            let offset = _mm256_cvtepi32_pd(pairs);
            *place = _mm256_mul_pd(_mm256_add_pd(base, offset), step);
        }
        places
    }
}
