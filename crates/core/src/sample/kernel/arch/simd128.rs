//! 128-bit vectors of WebAssembly: four lanes.

use core::arch::wasm32::*;

use super::super::lanes::{Lanes, VectorLoop};
use crate::sample::warp::{CELL_BITS, PatchShears};

/// Runs a loop.
///
/// # Safety
/// None beyond that of [`VectorLoop::run`]: the program is compiled with `simd128`.
#[inline]
pub(in super::super) unsafe fn run(work: &mut impl VectorLoop) -> usize {
    // SAFETY: the program is compiled with `simd128`.
    unsafe { work.run::<Simd128>() }
}

pub(in super::super) struct Simd128;

impl Lanes for Simd128 {
    const WIDTH: usize = 4;
    const WINDOW: usize = PatchShears::CELLS;

    type Ints = v128;
    type Singles = v128;
    type Doubles = [v128; 2];
    type Table = [v128; 4];

    #[inline(always)]
    unsafe fn load_ints(from: *const i32) -> v128 {
        unsafe { v128_load(from.cast()) }
    }

    #[inline(always)]
    unsafe fn store_ints(to: *mut i32, v: v128) {
        unsafe { v128_store(to.cast(), v) }
    }

    #[inline(always)]
    unsafe fn splat_int(v: i32) -> v128 {
        i32x4_splat(v)
    }

    #[inline(always)]
    unsafe fn add_ints(a: v128, b: v128) -> v128 {
        i32x4_add(a, b)
    }

    #[inline(always)]
    unsafe fn sub_ints(a: v128, b: v128) -> v128 {
        i32x4_sub(a, b)
    }

    #[inline(always)]
    unsafe fn cells(v: v128) -> v128 {
        i32x4_shr(v, CELL_BITS)
    }

    #[inline(always)]
    unsafe fn places(v: v128) -> v128 {
        v128_and(v, i32x4_splat(PatchShears::CELL_MASK))
    }

    #[inline(always)]
    unsafe fn load_singles(from: *const f32) -> v128 {
        unsafe { v128_load(from.cast()) }
    }

    #[inline(always)]
    unsafe fn splat_single(v: f32) -> v128 {
        f32x4_splat(v)
    }

    #[inline(always)]
    unsafe fn add_singles(a: v128, b: v128) -> v128 {
        f32x4_add(a, b)
    }

    #[inline(always)]
    unsafe fn mul_singles(a: v128, b: v128) -> v128 {
        f32x4_mul(a, b)
    }

    #[inline(always)]
    unsafe fn min_singles(a: v128, b: v128) -> v128 {
        // `pmin(b, a)` is a if a < b, else b.
        f32x4_pmin(b, a)
    }

    #[inline(always)]
    unsafe fn singles_of(v: v128) -> v128 {
        f32x4_convert_i32x4(v)
    }

    #[inline(always)]
    unsafe fn truncate(v: v128) -> v128 {
        i32x4_trunc_sat_f32x4(v)
    }

    #[inline(always)]
    unsafe fn table(all: &[f32; PatchShears::CELLS], _: i32) -> [v128; 4] {
        // SAFETY: the table has four quarters of four entries.
        [0, 4, 8, 12].map(|k| unsafe { v128_load(all.as_ptr().add(k).cast()) })
    }

    #[inline(always)]
    unsafe fn pick(table: [v128; 4], cells: v128) -> v128 {
        // Entry i is bytes 4i to 4i + 3. A swizzle returns 0 for bytes outside its 16, so the quarters of
        // the table can be combined.
        let cells = v128_and(cells, i32x4_splat(15));
        let bytes = i32x4_add(
            i32x4_mul(cells, i32x4_splat(0x0404_0404)),
            i32x4_splat(0x0302_0100),
        );
        let quarter =
            |k: usize| u8x16_swizzle(table[k], u8x16_sub(bytes, u8x16_splat(16 * k as u8)));
        v128_or(
            v128_or(quarter(0), quarter(1)),
            v128_or(quarter(2), quarter(3)),
        )
    }

    #[inline(always)]
    unsafe fn pick_any(all: &[f32; PatchShears::CELLS], cells: v128) -> v128 {
        unsafe { Self::pick(Self::table(all, 0), cells) }
    }

    #[inline(always)]
    unsafe fn load_doubles(from: *const f64) -> [v128; 2] {
        unsafe { [v128_load(from.cast()), v128_load(from.add(2).cast())] }
    }

    #[inline(always)]
    unsafe fn splat_double(v: f64) -> [v128; 2] {
        [f64x2_splat(v); 2]
    }

    #[inline(always)]
    unsafe fn add_doubles(a: [v128; 2], b: [v128; 2]) -> [v128; 2] {
        [f64x2_add(a[0], b[0]), f64x2_add(a[1], b[1])]
    }

    #[inline(always)]
    unsafe fn mul_doubles(a: [v128; 2], b: [v128; 2]) -> [v128; 2] {
        [f64x2_mul(a[0], b[0]), f64x2_mul(a[1], b[1])]
    }

    #[inline(always)]
    unsafe fn doubles_of(v: v128) -> [v128; 2] {
        let high = i32x4_shuffle::<2, 3, 2, 3>(v, v);
        [f64x2_convert_low_i32x4(v), f64x2_convert_low_i32x4(high)]
    }

    #[inline(always)]
    unsafe fn offsets(from: *const i32, y: i32) -> [v128; 2] {
        unsafe { Self::doubles_of(i32x4_add(v128_load(from.cast()), i32x4_splat(y))) }
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
