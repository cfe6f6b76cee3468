//! 512-bit vectors of x86-64: sixteen lanes.

use core::arch::x86_64::*;

use crate::{
    kernel::lanes::{Lanes, PlainLoop, VectorLoop},
    lattice::Point,
    table::FRACTION_BITS,
    warp::{CELL_BITS, PatchShears},
};

entries!(Avx512, "avx512f,avx512vl,avx512dq,avx2,popcnt");

pub(in crate::kernel) struct Avx512;

impl Lanes for Avx512 {
    const WIDTH: usize = 16;
    const WINDOW: usize = PatchShears::AT_ONCE;

    type Ints = __m512i;
    type Singles = __m512;
    type Doubles = [__m512d; 2];
    type Table = __m512;

    operations! {
        load_ints(from: *const i32) -> Self::Ints = _mm512_loadu_epi32(from);
        splat_int(v: i32) -> Self::Ints = _mm512_set1_epi32(v);
        add_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = _mm512_add_epi32(a, b);
        sub_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = _mm512_sub_epi32(a, b);
        min_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = _mm512_min_epi32(a, b);
        max_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = _mm512_max_epi32(a, b);
        fixed(v: Self::Ints) -> Self::Ints = _mm512_slli_epi32::<FRACTION_BITS>(v);
        cells(v: Self::Ints) -> Self::Ints = _mm512_srai_epi32::<CELL_BITS>(v);
        places(v: Self::Ints) -> Self::Ints =
            _mm512_and_si512(v, _mm512_set1_epi32(PatchShears::CELL_MASK));
        load_singles(from: *const f32) -> Self::Singles = _mm512_loadu_ps(from);
        splat_single(v: f32) -> Self::Singles = _mm512_set1_ps(v);
        add_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = _mm512_add_ps(a, b);
        mul_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = _mm512_mul_ps(a, b);
        min_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = _mm512_min_ps(a, b);
        singles_of(v: Self::Ints) -> Self::Singles = _mm512_cvtepi32_ps(v);
        truncate(v: Self::Singles) -> Self::Ints = _mm512_cvttps_epi32(v);
        bits_of(v: Self::Singles) -> Self::Ints = _mm512_castps_si512(v);
        table(from: *const f32) -> Self::Table = _mm512_loadu_ps(from);
        pick(table: Self::Table, places: Self::Ints) -> Self::Singles =
            _mm512_permutexvar_ps(places, table);
        pick_at_once(from: *const f32, places: Self::Ints) -> Self::Singles =
            Self::pick(Self::table(from), places);
        gather(from: *const f32, places: Self::Ints) -> Self::Singles =
            _mm512_i32gather_ps::<4>(places, from);
        load_doubles(from: *const f64) -> Self::Doubles =
            [_mm512_loadu_pd(from), _mm512_loadu_pd(from.add(8))];
        splat_double(v: f64) -> Self::Doubles = [_mm512_set1_pd(v); 2];
        add_doubles(a: Self::Doubles, b: Self::Doubles) -> Self::Doubles =
            [_mm512_add_pd(a[0], b[0]), _mm512_add_pd(a[1], b[1])];
        mul_doubles(a: Self::Doubles, b: Self::Doubles) -> Self::Doubles =
            [_mm512_mul_pd(a[0], b[0]), _mm512_mul_pd(a[1], b[1])];
        store_ints(to: *mut i32, v: Self::Ints) = _mm512_storeu_epi32(to, v);
        two_tables(from: *const f32) -> [Self::Singles; 2] =
            [_mm512_loadu_ps(from), _mm512_loadu_ps(from.add(16))];
        load_places(from: *const u16) -> Self::Ints =
            _mm512_cvtepu16_epi32(_mm256_loadu_si256(from.cast()));
        compress(v: Self::Ints, mask: u32) -> Self::Ints =
            _mm512_maskz_compress_epi32(mask as __mmask16, v);
    }

    #[inline(always)]
    unsafe fn doubles_of(v: __m512i) -> [__m512d; 2] {
        unsafe {
            let low = _mm512_cvtepi32_pd(_mm512_castsi512_si256(v));
            let high = _mm512_cvtepi32_pd(_mm512_extracti64x4_epi64::<1>(v));
            [low, high]
        }
    }

    #[inline(always)]
    unsafe fn offsets(from: *const i32, y: i32) -> [__m512d; 2] {
        unsafe {
            // Loads of halves need no shuffle.
            let half = |from: *const i32| {
                let sum = _mm256_add_epi32(_mm256_loadu_si256(from.cast()), _mm256_set1_epi32(y));
                _mm512_cvtepi32_pd(sum)
            };
            [half(from), half(from.add(8))]
        }
    }

    #[inline(always)]
    unsafe fn narrow([low, high]: [__m512d; 2]) -> __m512 {
        unsafe {
            let low = _mm512_castps256_ps512(_mm512_cvtpd_ps(low));
            _mm512_insertf32x8::<1>(low, _mm512_cvtpd_ps(high))
        }
    }

    #[inline(always)]
    unsafe fn store_single_pairs(to: *mut [f32; 2], x: __m512, y: __m512) {
        unsafe {
            let low = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
            let high =
                _mm512_setr_epi32(8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
            let to: *mut f32 = to.cast();
            _mm512_storeu_ps(to, _mm512_permutex2var_ps(x, low, y));
            _mm512_storeu_ps(to.add(16), _mm512_permutex2var_ps(x, high, y));
        }
    }

    #[inline(always)]
    unsafe fn store_double_pairs(to: *mut [f64; 2], x: [__m512d; 2], y: [__m512d; 2]) {
        unsafe {
            let low = _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11);
            let high = _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15);
            let to: *mut f64 = to.cast();
            for half in 0..2 {
                let to = to.add(16 * half);
                _mm512_storeu_pd(to, _mm512_permutex2var_pd(x[half], low, y[half]));
                _mm512_storeu_pd(to.add(8), _mm512_permutex2var_pd(x[half], high, y[half]));
            }
        }
    }

    const HAS_TRIPLES: bool = true;
    const HAS_COMPRESS: bool = true;

    #[inline(always)]
    unsafe fn pick_of_two([low, high]: [__m512; 2], places: __m512i) -> __m512 {
        unsafe { _mm512_permutex2var_ps(low, places, high) }
    }

    #[inline(always)]
    unsafe fn between(v: __m512i, least: i32, end: i32) -> u32 {
        unsafe {
            let above = _mm512_cmpge_epi32_mask(v, _mm512_set1_epi32(least));
            _mm512_mask_cmplt_epi32_mask(above, v, _mm512_set1_epi32(end)).into()
        }
    }

    #[inline(always)]
    unsafe fn store_single_triples(to: *mut [f32; 3], [x, y, z]: [__m512; 3]) {
        /// For the number at each place of 48, the lane that it is from: of y from 16 on; any for z.
        const PAIRS: [i32; 48] = {
            let mut pairs = [0; 48];
            let mut i = 0;
            while i < 48 {
                pairs[i] = i as i32 / 3 + if i % 3 == 1 { 16 } else { 0 };
                i += 1;
            }
            pairs
        };
        /// The places of z of three vectors.
        const THIRD: [__mmask16; 3] = [
            0b0100_1001_0010_0100,
            0b0010_0100_1001_0010,
            0b1001_0010_0100_1001,
        ];
        unsafe {
            let to: *mut f32 = to.cast();
            for (k, third) in THIRD.into_iter().enumerate() {
                let pairs = _mm512_loadu_epi32(PAIRS.as_ptr().add(16 * k));
                let both = _mm512_permutex2var_ps(x, pairs, y);
                let all = _mm512_mask_permutexvar_ps(both, third, pairs, z);
                _mm512_storeu_ps(to.add(16 * k), all);
            }
        }
    }

    const HAS_POINTS: bool = true;

    #[inline(always)]
    unsafe fn store_points(to: *mut Point, columns: *const [u64; 2], row: i64, y: [__m512d; 2]) {
        // A point is written as these four, in this order.
        const {
            assert!(size_of::<Point>() == 32);
            assert!(core::mem::offset_of!(Point, id.x) == 0);
            assert!(core::mem::offset_of!(Point, id.y) == 8);
            assert!(core::mem::offset_of!(Point, x) == 16);
            assert!(core::mem::offset_of!(Point, y) == 24);
        }
        unsafe {
            let row = _mm512_set1_pd(f64::from_bits(row as u64));
            // Two points each: column, (row), x, y.
            let pairs = [
                _mm512_setr_epi64(0, 0, 1, 8, 2, 0, 3, 9),
                _mm512_setr_epi64(4, 0, 5, 10, 6, 0, 7, 11),
                _mm512_setr_epi64(0, 0, 1, 12, 2, 0, 3, 13),
                _mm512_setr_epi64(4, 0, 5, 14, 6, 0, 7, 15),
            ];
            let (from, to): (*const f64, *mut f64) = (columns.cast(), to.cast());
            for (half, y) in y.into_iter().enumerate() {
                let from = from.add(16 * half);
                let columns = [_mm512_loadu_pd(from), _mm512_loadu_pd(from.add(8))];
                for (k, pair) in pairs.into_iter().enumerate() {
                    let points = _mm512_permutex2var_pd(columns[k / 2], pair, y);
                    let points = _mm512_mask_mov_pd(points, 0b0010_0010, row);
                    _mm512_storeu_pd(to.add(32 * half + 8 * k), points);
                }
            }
        }
    }
}
