//! 128-bit vectors of arm64: four lanes.

use core::arch::aarch64::*;

use crate::{
    kernel::lanes::{Lanes, VectorLoop},
    table::FRACTION_BITS,
    warp::{CELL_BITS, PatchShears},
};

/// Runs a loop.
///
/// # Safety
/// The machine has NEON.
#[target_feature(enable = "neon")]
pub(in crate::kernel) unsafe fn run(work: &mut impl VectorLoop) -> usize {
    // SAFETY: the machine has NEON.
    unsafe { work.run::<Neon>() }
}

pub(in crate::kernel) struct Neon;

/// The bytes of places: of entry i those from 4i to 4i + 3.
///
/// # Safety
/// The machine has NEON.
#[inline(always)]
unsafe fn bytes(places: int32x4_t) -> uint8x16_t {
    unsafe {
        let first = vdupq_n_u32(0x0302_0100);
        let places = vreinterpretq_u32_s32(places);
        vreinterpretq_u8_u32(vmlaq_u32(first, places, vdupq_n_u32(0x0404_0404)))
    }
}

impl Lanes for Neon {
    const WIDTH: usize = 4;
    const WINDOW: usize = 8;

    type Ints = int32x4_t;
    type Singles = float32x4_t;
    type Doubles = [float64x2_t; 2];
    type Table = uint8x16x2_t;

    operations! {
        load_ints(from: *const i32) -> Self::Ints = vld1q_s32(from);
        splat_int(v: i32) -> Self::Ints = vdupq_n_s32(v);
        add_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = vaddq_s32(a, b);
        sub_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = vsubq_s32(a, b);
        min_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = vminq_s32(a, b);
        max_ints(a: Self::Ints, b: Self::Ints) -> Self::Ints = vmaxq_s32(a, b);
        fixed(v: Self::Ints) -> Self::Ints = vshlq_n_s32::<{ FRACTION_BITS as i32 }>(v);
        cells(v: Self::Ints) -> Self::Ints = vshrq_n_s32::<{ CELL_BITS as i32 }>(v);
        places(v: Self::Ints) -> Self::Ints = vandq_s32(v, vdupq_n_s32(PatchShears::CELL_MASK));
        load_singles(from: *const f32) -> Self::Singles = vld1q_f32(from);
        splat_single(v: f32) -> Self::Singles = vdupq_n_f32(v);
        add_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = vaddq_f32(a, b);
        mul_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles = vmulq_f32(a, b);
        // Not `vminq_f32`, which orders the two zeros.
        min_singles(a: Self::Singles, b: Self::Singles) -> Self::Singles =
            vbslq_f32(vcltq_f32(a, b), a, b);
        bits_of(v: Self::Singles) -> Self::Ints = vreinterpretq_s32_f32(v);
        singles_of(v: Self::Ints) -> Self::Singles = vcvtq_f32_s32(v);
        truncate(v: Self::Singles) -> Self::Ints = vcvtq_s32_f32(v);
        table(from: *const f32) -> Self::Table = vld1q_u8_x2(from.cast());
        pick(table: Self::Table, places: Self::Ints) -> Self::Singles =
            vreinterpretq_f32_u8(vqtbl2q_u8(table, bytes(places)));
        load_doubles(from: *const f64) -> Self::Doubles = [vld1q_f64(from), vld1q_f64(from.add(2))];
        splat_double(v: f64) -> Self::Doubles = [vdupq_n_f64(v); 2];
        add_doubles(a: Self::Doubles, b: Self::Doubles) -> Self::Doubles =
            [vaddq_f64(a[0], b[0]), vaddq_f64(a[1], b[1])];
        mul_doubles(a: Self::Doubles, b: Self::Doubles) -> Self::Doubles =
            [vmulq_f64(a[0], b[0]), vmulq_f64(a[1], b[1])];
        offsets(from: *const i32, y: i32) -> Self::Doubles =
            Self::doubles_of(vaddq_s32(vld1q_s32(from), vdupq_n_s32(y)));
        store_ints(to: *mut i32, v: Self::Ints) = vst1q_s32(to, v);
        store_single_pairs(to: *mut [f32; 2], x: Self::Singles, y: Self::Singles) =
            vst2q_f32(to.cast(), float32x4x2_t(x, y));
    }

    #[inline(always)]
    unsafe fn pick_at_once(from: *const f32, places: int32x4_t) -> float32x4_t {
        unsafe {
            let table = vld1q_u8_x4(from.cast());
            vreinterpretq_f32_u8(vqtbl4q_u8(table, bytes(places)))
        }
    }

    #[inline(always)]
    unsafe fn doubles_of(v: int32x4_t) -> [float64x2_t; 2] {
        unsafe {
            let low = vcvtq_f64_s64(vmovl_s32(vget_low_s32(v)));
            let high = vcvtq_f64_s64(vmovl_high_s32(v));
            [low, high]
        }
    }

    #[inline(always)]
    unsafe fn narrow([low, high]: [float64x2_t; 2]) -> float32x4_t {
        unsafe { vcvt_high_f32_f64(vcvt_f32_f64(low), high) }
    }

    #[inline(always)]
    unsafe fn store_double_pairs(to: *mut [f64; 2], x: [float64x2_t; 2], y: [float64x2_t; 2]) {
        unsafe {
            let to: *mut f64 = to.cast();
            vst2q_f64(to, float64x2x2_t(x[0], y[0]));
            vst2q_f64(to.add(4), float64x2x2_t(x[1], y[1]));
        }
    }
}
