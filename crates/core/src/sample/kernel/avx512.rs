//! Rows by 512-bit vectors: the same operations in the same order as the definition.

use core::arch::x86_64::*;

use super::{Format, Point, Row, shear::Columns};
use crate::sample::warp::{CELL_BITS, PATCH_CELL_MASK, PATCH_CELLS, PatchShears};

/// Sixteen entries of a table, by the lowest four bits of their index.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
fn pick(table: &[f32; PATCH_CELLS], index: __m512i) -> __m512 {
    // SAFETY: the table has sixteen entries.
    let entries = unsafe { _mm512_loadu_ps(table.as_ptr()) };
    _mm512_permutexvar_ps(index, entries)
}

/// So many vectors at once: their chains of operations are long and do not depend on each other.
const SIDE_BY_SIDE: usize = 2;

type Vectors = [__m512i; SIDE_BY_SIDE];

/// g of coordinates across a direction; see [`PatchShears`].
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
fn noise(shears: &PatchShears, direction: usize, s: Vectors) -> Vectors {
    let cell = s.map(|s| _mm512_srai_epi32::<{ CELL_BITS }>(s));
    let unit = _mm512_set1_ps(1.0 / (1u32 << CELL_BITS) as f32);
    let u = s.map(|s| {
        let at = _mm512_and_si512(s, _mm512_set1_epi32(PATCH_CELL_MASK));
        _mm512_mul_ps(_mm512_cvtepi32_ps(at), unit)
    });
    let table = &shears.cubics[direction];
    let mut value = cell.map(|cell| pick(&table[3], cell));
    for power in [2, 1, 0] {
        for (i, value) in value.iter_mut().enumerate() {
            *value = _mm512_add_ps(_mm512_mul_ps(*value, u[i]), pick(&table[power], cell[i]));
        }
    }
    value.map(|value| _mm512_cvttps_epi32(value))
}

#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
fn add(a: Vectors, b: Vectors) -> Vectors {
    core::array::from_fn(|i| _mm512_add_epi32(a[i], b[i]))
}

#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
fn sub(a: Vectors, b: Vectors) -> Vectors {
    core::array::from_fn(|i| _mm512_sub_epi32(a[i], b[i]))
}

/// Warped positions; see [`PatchShears::apply`].
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
fn warp(shears: &PatchShears, x: Vectors, y: Vectors) -> (Vectors, Vectors) {
    let x = add(x, noise(shears, 0, y));
    let y = add(y, noise(shears, 1, x));
    let rising = noise(shears, 2, sub(x, y));
    let (x, y) = (add(x, rising), add(y, rising));
    let falling = noise(shears, 3, add(x, y));
    (add(x, falling), sub(y, falling))
}

/// Points made at once.
const AT_ONCE: usize = 16 * SIDE_BY_SIDE;

/// The displaced columns of a row from `i` on, warped.
///
/// # Safety
/// There are [`AT_ONCE`] columns from `i` on.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
unsafe fn warped(
    shears: &PatchShears,
    ys: __m512i,
    columns: &Columns<'_>,
    i: usize,
) -> (Vectors, Vectors) {
    // SAFETY: as the caller says.
    let load = |from: &[i32]| -> Vectors {
        core::array::from_fn(|k| unsafe { _mm512_loadu_epi32(from.as_ptr().add(i + 16 * k)) })
    };
    let dy = load(columns.displacements);
    warp(shears, load(columns.displaced), add(dy, [ys; SIDE_BY_SIDE]))
}

/// A warped row's points, unless there are too few to fill vectors; gives how many.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
pub(super) fn warped_row<F: Format>(
    format: &F,
    shears: &PatchShears,
    row: Row,
    columns: Columns<'_>,
    out: &mut [F::Item],
) -> usize {
    let length = columns.least(out.len());
    if length < AT_ONCE {
        return 0;
    }
    let ys = _mm512_set1_epi32(row.y);
    let mut next = 0;
    while next < length {
        // The last vectors go back over points that are made already.
        let start = next.min(length - AT_ONCE);
        next += AT_ONCE;
        let (mut x, mut y) = ([0i32; AT_ONCE], [0i32; AT_ONCE]);
        // SAFETY: there are so many columns, and both arrays hold as many values.
        unsafe {
            let (to_x, to_y) = warped(shears, ys, &columns, start);
            for k in 0..SIDE_BY_SIDE {
                _mm512_storeu_epi32(x.as_mut_ptr().add(16 * k), to_x[k]);
                _mm512_storeu_epi32(y.as_mut_ptr().add(16 * k), to_y[k]);
            }
        }
        let lattice = &columns.lattice[start..start + AT_ONCE];
        for (i, out) in out[start..start + AT_ONCE].iter_mut().enumerate() {
            let column = format.column(row.base, x[i], lattice[i]);
            *out = format.item(row.base, column, y[i], row.lattice);
        }
    }
    length
}

/// Sixteen offsets as `f32` places; see [`F32`](super::F32).
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
fn near(base: __m512d, step: __m512d, last: __m512, offset: __m512i) -> __m512 {
    let half = |offset: __m256i| {
        let place = _mm512_mul_pd(_mm512_add_pd(base, _mm512_cvtepi32_pd(offset)), step);
        _mm512_cvtpd_ps(place)
    };
    let low = half(_mm512_castsi512_si256(offset));
    let high = half(_mm512_extracti64x4_epi64::<1>(offset));
    _mm512_min_ps(
        _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high),
        last,
    )
}

/// A warped row's `f32` pairs, unless there are too few to fill vectors; gives how many.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
pub(super) fn warped_f32_row(
    (step, last): (f64, [f32; 2]),
    shears: &PatchShears,
    row: Row,
    columns: Columns<'_>,
    out: &mut [[f32; 2]],
) -> usize {
    let length = columns.least(out.len());
    if length < AT_ONCE {
        return 0;
    }
    let ys = _mm512_set1_epi32(row.y);
    let bases = row.base.map(|base| _mm512_set1_pd(base));
    let (steps, lasts) = (_mm512_set1_pd(step), last.map(|last| _mm512_set1_ps(last)));
    let low = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
    let high = _mm512_setr_epi32(8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
    let mut next = 0;
    while next < length {
        // The last vectors go back over points that are made already.
        let i = next.min(length - AT_ONCE);
        next += AT_ONCE;
        // SAFETY: so many values from `i` on lie within the slices.
        unsafe {
            let (x, y) = warped(shears, ys, &columns, i);
            for k in 0..SIDE_BY_SIDE {
                let to: *mut f32 = out.as_mut_ptr().add(i + 16 * k).cast();
                let x = near(bases[0], steps, lasts[0], x[k]);
                let y = near(bases[1], steps, lasts[1], y[k]);
                _mm512_storeu_ps(to, _mm512_permutex2var_ps(x, low, y));
                _mm512_storeu_ps(to.add(16), _mm512_permutex2var_ps(x, high, y));
            }
        }
    }
    length
}

/// A row of `f32` pairs; see [`F32`](super::F32). All three slices have the same length.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
pub(super) fn f32_row(
    (base, step, last): (f64, f64, f32),
    y: i32,
    columns: &[f32],
    displacements: &[i32],
    out: &mut [[f32; 2]],
) {
    let length = out.len().min(columns.len()).min(displacements.len());
    let (bases, steps) = (_mm512_set1_pd(base), _mm512_set1_pd(step));
    let (lasts, ys) = (_mm256_set1_ps(last), _mm256_set1_epi32(y));
    let pairs = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
    let place = |displacement: __m256i| {
        let offset = _mm512_cvtepi32_pd(_mm256_add_epi32(displacement, ys));
        let place = _mm512_mul_pd(_mm512_add_pd(bases, offset), steps);
        _mm256_min_ps(_mm512_cvtpd_ps(place), lasts)
    };
    let pair = |column: __m256, place: __m256| {
        _mm512_permutex2var_ps(
            _mm512_castps256_ps512(column),
            pairs,
            _mm512_castps256_ps512(place),
        )
    };
    let (from_x, from_y) = (columns.as_ptr(), displacements.as_ptr());
    let to: *mut f32 = out.as_mut_ptr().cast();
    let mut next = if length < 16 { length } else { 0 };
    while next < length {
        // The last vector goes back over points that are made already.
        let i = next.min(length - 16);
        next += 16;
        // SAFETY: sixteen values from `i` on lie within the three slices.
        unsafe {
            let first = place(_mm256_loadu_si256(from_y.add(i).cast()));
            let second = place(_mm256_loadu_si256(from_y.add(i + 8).cast()));
            let first = pair(_mm256_loadu_ps(from_x.add(i)), first);
            let second = pair(_mm256_loadu_ps(from_x.add(i + 8)), second);
            _mm512_storeu_ps(to.add(2 * i), first);
            _mm512_storeu_ps(to.add(2 * i + 16), second);
        }
    }
    let few = if length < 16 { length } else { 0 };
    let mut i = 0;
    while i < few {
        let left = (few - i).min(8);
        let mask = ((1u16 << left) - 1) as u8;
        // SAFETY: lanes that the mask leaves out are neither read nor written, and the others lie
        // within the three slices, whose least length is `length`.
        unsafe {
            let place = place(_mm256_maskz_loadu_epi32(mask, from_y.add(i)));
            let both = pair(_mm256_maskz_loadu_ps(mask, from_x.add(i)), place);
            let mask = ((1u32 << (2 * left)) - 1) as u16;
            _mm512_mask_storeu_ps(to.add(2 * i), mask, both);
        }
        i += 8;
    }
}

/// A row of `f64` pairs; see [`F64`](super::F64). All three slices have the same length.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
pub(super) fn f64_row(
    (base, step): (f64, f64),
    y: i32,
    columns: &[f64],
    displacements: &[i32],
    out: &mut [[f64; 2]],
) {
    let length = out.len().min(columns.len()).min(displacements.len());
    let (bases, steps) = (_mm512_set1_pd(base), _mm512_set1_pd(step));
    let ys = _mm256_set1_epi32(y);
    let low = _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11);
    let high = _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15);
    let mut i = 0;
    while i < length {
        let left = (length - i).min(8);
        let mask = ((1u16 << left) - 1) as u8;
        // SAFETY: as in `f32_row`.
        unsafe {
            let displacement = _mm256_maskz_loadu_epi32(mask, displacements.as_ptr().add(i));
            let offset = _mm512_cvtepi32_pd(_mm256_add_epi32(displacement, ys));
            let place = _mm512_mul_pd(_mm512_add_pd(bases, offset), steps);
            let column = _mm512_maskz_loadu_pd(mask, columns.as_ptr().add(i));
            let to: *mut f64 = out.as_mut_ptr().add(i).cast();
            let first = _mm512_permutex2var_pd(column, low, place);
            let second = _mm512_permutex2var_pd(column, high, place);
            if left == 8 {
                _mm512_storeu_pd(to, first);
                _mm512_storeu_pd(to.add(8), second);
            } else {
                let mask = (1u32 << (2 * left)) - 1;
                _mm512_mask_storeu_pd(to, mask as u8, first);
                if left > 4 {
                    _mm512_mask_storeu_pd(to.add(8), (mask >> 8) as u8, second);
                }
            }
        }
        i += 8;
    }
}

/// A row of points, unless there are too few to fill a vector; gives how many. All three slices have
/// the same length.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2")]
pub(super) fn points_row(
    step: f64,
    row: Row,
    columns: &[[u64; 2]],
    displacements: &[i32],
    out: &mut [Point],
) -> usize {
    // A point is written as these four, in this order.
    const {
        assert!(size_of::<Point>() == 32);
        assert!(core::mem::offset_of!(Point, id.x) == 0);
        assert!(core::mem::offset_of!(Point, id.y) == 8);
        assert!(core::mem::offset_of!(Point, x) == 16);
        assert!(core::mem::offset_of!(Point, y) == 24);
    }
    let length = out.len().min(columns.len()).min(displacements.len());
    if length < 8 {
        return 0;
    }
    let (bases, steps) = (_mm512_set1_pd(row.base[1]), _mm512_set1_pd(step));
    let ys = _mm256_set1_epi32(row.y);
    let lattice = _mm512_set1_pd(f64::from_bits(row.lattice as u64));
    // Two points each: column, (row), x, y.
    let pairs = [
        _mm512_setr_epi64(0, 0, 1, 8, 2, 0, 3, 9),
        _mm512_setr_epi64(4, 0, 5, 10, 6, 0, 7, 11),
        _mm512_setr_epi64(0, 0, 1, 12, 2, 0, 3, 13),
        _mm512_setr_epi64(4, 0, 5, 14, 6, 0, 7, 15),
    ];
    let mut next = 0;
    while next < length {
        // The last vector goes back over points that are made already.
        let i = next.min(length - 8);
        next += 8;
        // SAFETY: eight values from `i` on lie within the three slices.
        unsafe {
            let displacement = _mm256_loadu_si256(displacements.as_ptr().add(i).cast());
            let offset = _mm512_cvtepi32_pd(_mm256_add_epi32(displacement, ys));
            let places = _mm512_mul_pd(_mm512_add_pd(bases, offset), steps);
            let from: *const f64 = columns.as_ptr().add(i).cast();
            let halves = [_mm512_loadu_pd(from), _mm512_loadu_pd(from.add(8))];
            let to: *mut f64 = out.as_mut_ptr().add(i).cast();
            for (k, pair) in pairs.into_iter().enumerate() {
                let points = _mm512_permutex2var_pd(halves[k / 2], pair, places);
                let points = _mm512_mask_mov_pd(points, 0b0010_0010, lattice);
                _mm512_storeu_pd(to.add(8 * k), points);
            }
        }
    }
    length
}
