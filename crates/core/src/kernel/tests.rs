//! Rows by every backend beside plain code, bit for bit: all lengths around the widths of vectors, slices
//! that begin anywhere, and memory before and after them that must stay as it is. Under a memory checker
//! (`just sanitize`) these tests also show that nothing beyond a slice is read.

use alloc::{vec, vec::Vec};

use super::{
    Backend, Extent, F32, F64, Format, Geometry, Offsets, Points, Row, WarpedColumns,
    add_first_shear, format::Emit as _, listing::emit, warp_all, write_numbers,
};
use crate::{
    lattice::{Point, PointId, seed::Seed},
    warp::{PatchShears, Shears, Warp, Waves},
};

/// The longest row: four vectors of 16 and a rest.
const LONGEST: usize = 70;
/// The number of places in memory at which slices begin.
const SHIFTS: usize = 4;

/// Numbers that look random.
fn numbers(seed: u64) -> impl Iterator<Item = u64> {
    let mut state = seed;
    core::iter::from_fn(move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        Some(state >> 20)
    })
}

/// A row of a patch: columns in lattice order, each displaced by some units.
struct Example {
    lattice: Vec<i64>,
    displaced: Vec<i32>,
    displacements: Vec<i32>,
    extent: Extent,
    row: Row,
}

/// The lattice column of the patch's origin.
const ORIGIN: i64 = -3_000_000_000;

fn examples() -> impl Iterator<Item = Example> {
    let length = LONGEST + SHIFTS + 8;
    // The lowest and the highest row of a patch, and some between; the distance of columns, and a gap between some:
    // 8 columns lie within 256 grid units, within 512, and in more.
    [
        (0, 0, 12, 0),
        (255, 1, 12, 0),
        (17, 2, 11, 80),
        (128, 3, 6, 450),
    ]
    .map(|(y, seed, distance, gap)| {
        let vector = |n: u64| (n % (20 << 20)) as i32 - (10 << 20);
        let column = |i: usize| i as i64 * distance + if i < 37 { 0 } else { gap };
        let places = numbers(seed).map(vector).take(length).enumerate();
        let lattice: Vec<i64> = (0..length).map(|i| ORIGIN + column(i)).collect();
        Example {
            extent: Extent::new(ORIGIN, [-10 << 20, 10 << 20], &lattice),
            lattice,
            displaced: places
                .map(|(i, dx)| ((column(i) as i32) << 20) + dx)
                .collect(),
            displacements: numbers(seed + 9).map(vector).take(length).collect(),
            row: Row {
                base: [(1i64 << 40) as f64 + 0.25, -(3i64 << 50) as f64],
                y: y << 20,
                lattice: -77 + i64::from(y),
            },
        }
    })
    .into_iter()
}

/// Runs `make` at several places of some memory and compares what it wrote with `expected`, and what lies
/// around with what was there. `make` returns the number of items written.
fn assert_written<I: Copy, B: PartialEq + core::fmt::Debug>(
    canary: I,
    bits: impl Fn(I) -> B,
    expected: &[I],
    make: impl Fn(&mut [I]) -> usize,
    note: &str,
) {
    for shift in 0..SHIFTS {
        let mut memory = vec![canary; expected.len() + 2 * SHIFTS];
        let made = make(&mut memory[shift..shift + expected.len()]);
        assert!(made <= expected.len(), "{note}");
        let (before, rest) = memory.split_at(shift);
        let (written, after) = rest.split_at(made);
        for (i, (&is, &should)) in written.iter().zip(expected).enumerate() {
            assert_eq!(bits(is), bits(should), "{note}: item {i}, shift {shift}");
        }
        for &untouched in before.iter().chain(after) {
            assert_eq!(bits(untouched), bits(canary), "{note}: shift {shift}");
        }
    }
}

/// The shears of a patch.
fn shears() -> PatchShears {
    let shears = Shears::new(Waves::All, Warp::ON, Seed(5)).expect("on");
    PatchShears::new(
        &shears,
        [1024 * 7, -256 * 3],
        [[-20 << 20, 1040 << 20], [-20 << 20, 280 << 20]],
    )
}

#[test]
fn first_shears_have_the_same_bits_by_all_backends() {
    let shears = shears();
    for example in examples() {
        for length in 0..=LONGEST {
            let (lattice, displaced) = (&example.lattice[..length], &example.displaced[..length]);
            let before = &example.displacements[..length];
            let expected: Vec<i32> = before
                .iter()
                .zip(displaced)
                .map(|(dy, &x)| dy + shears.first(x))
                .collect();
            for backend in Backend::available() {
                let mut moved = before.to_vec();
                let columns = (example.extent, lattice);
                add_first_shear(backend, &shears, columns, displaced, &mut moved);
                assert_eq!(moved, expected, "{backend:?}, {length}");
            }
        }
    }
}

/// Lists of some hundred points in rows of several widths.
#[test]
fn lists_have_the_same_bits_by_all_backends() {
    let shears = shears();
    for width in [1u64, 40, 130, 330, 1000] {
        for length in [0, 32, 256, 480] {
            let place = |n: u64, size: u64| ((n % (size << 20)) as i32) + (3 << 20);
            let x: Vec<i32> = numbers(width)
                .map(|n| place(n, width))
                .take(length)
                .collect();
            let rows = numbers(7).enumerate();
            let y: Vec<i32> = rows
                .map(|(i, n)| place(n, 26) + ((i as i32 / 4) << 20))
                .take(length)
                .collect();
            let moved = x.iter().zip(&y).map(|(&x, &y)| shears.apply(x, y));
            let expected: (Vec<i32>, Vec<i32>) = moved.map(|[x, y]| (x, y)).unzip();
            for backend in Backend::available() {
                let (mut xs, mut ys) = (x.clone(), y.clone());
                warp_all(backend, &shears, [&mut xs, &mut ys]);
                assert_eq!((xs, ys), expected, "{backend:?}, {width}, {length}");
            }
        }
    }
}

/// Plain and warped rows of a format by all backends.
fn all_rows<F: Format, B: PartialEq + core::fmt::Debug>(
    format: F,
    canary: F::Item,
    bits: impl Fn(F::Item) -> B + Copy,
) {
    let shears = shears();
    for example in examples() {
        let Example {
            lattice,
            displaced,
            displacements,
            extent,
            row,
        } = &example;
        let places = displaced.iter().zip(lattice);
        let columns: Vec<F::Column> = places
            .map(|(&x, &column)| format.column(row.base, x, column))
            .collect();
        for length in 0..=LONGEST {
            for from in 0..SHIFTS {
                // Copies that end where the slices end, so that a checker sees reads beyond.
                let part = from..from + length;
                let columns = columns[..part.end].to_vec();
                let [displaced, displacements] =
                    [displaced, displacements].map(|all| all[..part.end].to_vec());
                let lattice = lattice[..part.end].to_vec();
                let (own, dys) = (&columns[from..], &displacements[from..]);
                let mut plain = vec![canary; length];
                emit(&format, *row, own, dys, &mut plain);
                let moved: Vec<F::Item> = part
                    .map(|i| {
                        let [x, y] = shears.apply_others(displaced[i], row.y + displacements[i]);
                        let column = format.column(row.base, x, lattice[i]);
                        format.item(row.base, column, y, row.lattice)
                    })
                    .collect();
                let warped = WarpedColumns {
                    displaced: &displaced[from..],
                    displacements: dys,
                    range: [dys.iter().min(), dys.iter().max()].map(|v| v.copied().unwrap_or(0)),
                    lattice: &lattice[from..],
                    extent: *extent,
                };
                for backend in Backend::available() {
                    let note = alloc::format!("{format:?} {backend:?} {length} from {from}");
                    let fill = |out: &mut [F::Item]| {
                        format.fill_row(backend, *row, own, dys, out);
                        out.len()
                    };
                    assert_written(canary, bits, &plain, fill, &note);
                    let all = |out: &mut [F::Item]| {
                        format.fill_warped_row(backend, &shears, *row, warped, out);
                        out.len()
                    };
                    assert_written(canary, bits, &moved, all, &note);
                }
            }
        }
    }
}

#[test]
fn rows_have_the_same_bits_by_all_backends() {
    let step = 3.7e-7;
    // Some places are above these.
    let last = [410_000.0f32, -1.249_4e9];
    let format = F32 {
        step,
        first: [0, 0],
        lead: [0.25, 0.0],
        last,
    };
    all_rows(format, [-1.5; 2], |item| item.map(f32::to_bits));
    all_rows(F64 { step }, [-1.5; 2], |item| item.map(f64::to_bits));
    let format = Offsets::new(&Geometry {
        step,
        first: [77, -(5 << 40) + 3],
        gap: [[1.3e-7, 4e-24], [0.0; 2]],
        extent: last.map(f64::from),
    });
    all_rows(format, [-1.5; 2], |item| item.map(f64::to_bits));
    let canary = Point {
        id: PointId { x: -1, y: -2 },
        x: -1.5,
        y: -2.5,
    };
    let bits = |p: Point| (p.id, p.x.to_bits(), p.y.to_bits());
    all_rows(Points(F64 { step }), canary, bits);
    assert!(Backend::available().any(|backend| backend == Backend::best()));
}

/// Slices of different lengths: only what all of them hold is written.
#[test]
fn rows_end_where_the_shortest_slice_ends() {
    let format = F32 {
        step: 3.7e-7,
        first: [0, 0],
        lead: [0.0; 2],
        last: [1e30; 2],
    };
    let example = examples().next().expect("some");
    let all: Vec<f32> = numbers(3).map(|n| n as f32).take(LONGEST).collect();
    for backend in Backend::available() {
        for [columns, displacements, room] in [[5, 40, 70], [70, 33, 8], [40, 70, 17], [16, 15, 32]]
        {
            let (columns, dys) = (&all[..columns], &example.displacements[..displacements]);
            let least = columns.len().min(dys.len()).min(room);
            let mut expected = vec![[-1.5; 2]; room];
            emit(&format, example.row, columns, dys, &mut expected);
            assert!(expected[least..].iter().all(|item| *item == [-1.5; 2]));
            let mut out = vec![[-1.5; 2]; room];
            format.fill_row(backend, example.row, columns, dys, &mut out);
            assert_eq!(out, expected, "{backend:?}");
        }
    }
}

#[test]
fn hashed_numbers_have_the_same_bits_as_plain_ones() {
    for length in 0..=LONGEST {
        let number = |n: u64| (n.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11) as f64;
        let keys: Vec<u64> = numbers(4).take(length).collect();
        let expected: Vec<f64> = keys.iter().copied().map(number).collect();
        let note = alloc::format!("{length}");
        let make = |out: &mut [f64]| {
            write_numbers(numbers(4).map(number), out);
            out.len()
        };
        assert_written(-1.5, f64::to_bits, &expected, make, &note);
        // As attributes come: from an exact-size iterator, which compilers can vectorize.
        let make = |out: &mut [f64]| {
            write_numbers(keys.iter().copied().map(number), out);
            out.len()
        };
        assert_written(-1.5, f64::to_bits, &expected, make, &note);
    }
}
