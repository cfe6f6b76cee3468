//! 128-bit vectors of WebAssembly: four lanes.

use core::arch::wasm32::*;

use crate::{
    kernel::lanes::{Lanes, VectorLoop},
    table::FRACTION_BITS,
    warp::{CELL_BITS, PatchShears},
};

/// Runs a loop.
///
/// # Safety
/// None beyond that of [`VectorLoop::run`]: the program is compiled with `simd128`.
#[inline]
pub(in crate::kernel) unsafe fn run(work: &mut impl VectorLoop) -> usize {
    // SAFETY: the program is compiled with `simd128`.
    unsafe { work.run::<Simd128>() }
}

pub(in crate::kernel) struct Simd128;

/// The bytes of places: of entry i those from 4i to 4i + 3.
#[inline(always)]
fn bytes(places: v128) -> v128 {
    i32x4_add(
        i32x4_mul(places, i32x4_splat(0x0404_0404)),
        i32x4_splat(0x0302_0100),
    )
}

/// The bytes of a table that are in its quarter number `k`. A swizzle returns 0 for bytes outside its 16, so
/// quarters can be combined.
#[inline(always)]
fn quarter(entries: v128, bytes: v128, k: u8) -> v128 {
    u8x16_swizzle(entries, u8x16_sub(bytes, u8x16_splat(16 * k)))
}

impl Lanes for Simd128 {
    const WIDTH: usize = 4;
    const WINDOW: usize = 8;

    type Ints = v128;
    type Singles = v128;
    type Doubles = [v128; 2];
    type Table = [v128; 2];

    operations! {
        load_ints(from: *const i32) -> Self::Ints = v128_load(from.cast());
        splat_int(v: i32) -> Self::Ints = i32x4_splat(v);
        add_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = i32x4_add(a, b);
        sub_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = i32x4_sub(a, b);
        min_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = i32x4_min(a, b);
        max_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = i32x4_max(a, b);
        fixed(v: Self::Ints) -> Self::Ints = i32x4_shl(v, FRACTION_BITS);
        cells(v: Self::Ints) -> Self::Ints = i32x4_shr(v, CELL_BITS);
        places(v: Self::Ints) -> Self::Ints = v128_and(v, i32x4_splat(PatchShears::CELL_MASK));
        load_singles(from: *const f32) -> Self::Singles = v128_load(from.cast());
        splat_single(v: f32) -> Self::Singles = f32x4_splat(v);
        add_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = f32x4_add(a, b);
        mul_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = f32x4_mul(a, b);
        // `pmin(b, a)` is a if a < b, else b.
        min_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = f32x4_pmin(b, a);
        bits_of(v: Self::Singles) -> Self::Ints = v;
        singles_of(v: Self::Ints) -> Self::Singles = f32x4_convert_i32x4(v);
        truncate(v: Self::Singles) -> Self::Ints = i32x4_trunc_sat_f32x4(v);
        table(from: *const f32) -> Self::Table = [0, 4].map(|k| v128_load(from.add(k).cast()));
        load_doubles(from: *const f64) -> Self::Doubles =
            [v128_load(from.cast()), v128_load(from.add(2).cast())];
        splat_double(v: f64) -> Self::Doubles = [f64x2_splat(v); 2];
        add_doubles(a: Self::Doubles, b: Self::Doubles) -> Self::Doubles =
            [f64x2_add(a[0], b[0]), f64x2_add(a[1], b[1])];
        mul_doubles(a: Self::Doubles, b: Self::Doubles) -> Self::Doubles =
            [f64x2_mul(a[0], b[0]), f64x2_mul(a[1], b[1])];
        offsets(from: *const i32, y: i32) -> Self::Doubles =
            Self::doubles_of(i32x4_add(v128_load(from.cast()), i32x4_splat(y)));
        store_ints(to: *mut i32, v: Self::Ints) = v128_store(to.cast(), v);
    }

    #[inline(always)]
    unsafe fn pick(table: [v128; 2], places: v128) -> v128 {
        let bytes = bytes(places);
        v128_or(quarter(table[0], bytes, 0), quarter(table[1], bytes, 1))
    }

    #[inline(always)]
    unsafe fn pick_at_once(from: *const f32, places: v128) -> v128 {
        // SAFETY: there are 16 coefficients.
        let [low, high] = [0, 8].map(|k| unsafe { Self::table(from.add(k)) });
        let bytes = bytes(places);
        let low = v128_or(quarter(low[0], bytes, 0), quarter(low[1], bytes, 1));
        let high = v128_or(quarter(high[0], bytes, 2), quarter(high[1], bytes, 3));
        v128_or(low, high)
    }

    #[inline(always)]
    unsafe fn doubles_of(v: v128) -> [v128; 2] {
        let high = i32x4_shuffle::<2, 3, 2, 3>(v, v);
        [f64x2_convert_low_i32x4(v), f64x2_convert_low_i32x4(high)]
    }

    #[inline(always)]
    unsafe fn narrow([low, high]: [v128; 2]) -> v128 {
        let (low, high) = (f32x4_demote_f64x2_zero(low), f32x4_demote_f64x2_zero(high));
        i32x4_shuffle::<0, 1, 4, 5>(low, high)
    }

    #[inline(always)]
    unsafe fn store_single_pairs(to: *mut [f32; 2], x: v128, y: v128) {
        unsafe {
            let to: *mut v128 = to.cast();
            v128_store(to, i32x4_shuffle::<0, 4, 1, 5>(x, y));
            v128_store(to.add(1), i32x4_shuffle::<2, 6, 3, 7>(x, y));
        }
    }

    #[inline(always)]
    unsafe fn store_double_pairs(to: *mut [f64; 2], x: [v128; 2], y: [v128; 2]) {
        unsafe {
            let to: *mut v128 = to.cast();
            for half in 0..2 {
                let to = to.add(2 * half);
                v128_store(to, i64x2_shuffle::<0, 2>(x[half], y[half]));
                v128_store(to.add(1), i64x2_shuffle::<1, 3>(x[half], y[half]));
            }
        }
    }
}
