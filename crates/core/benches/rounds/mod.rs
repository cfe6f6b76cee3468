//! Shared code of the benches: a table, medians of interleaved rounds, and filling a whole plan.

#![allow(dead_code, reason = "each bench takes what it needs")]

use std::{hint::black_box, time::Instant};

use strew_core::{Alpha, Format, Map, Plan, PointSet, Region, Table, table::Provenance};

/// Points per reused block: 512 KiB of f32 pairs.
pub const BLOCK: usize = 65_536;

/// Whether to check only that everything runs: with `--quick`, or with `--test`, which
/// `cargo test --benches` passes.
pub fn is_quick() -> bool {
    std::env::args().any(|arg| arg == "--quick" || arg == "--test")
}

/// A table of the default size with random displacements.
pub fn table() -> Table {
    let map = Map::new("(5-sqrt(3))/2".parse::<Alpha>().expect("valid"), 49).expect("small");
    let blocks = map.intervals() * map.intervals();
    let mut state = 1u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 42) as i32 - (1 << 21)
    };
    let vectors = (0..blocks).map(|_| [next(), next()]).collect();
    Table::new(map, "bench", vectors, Provenance::default()).expect("valid")
}

/// The plain and a warped set of [`table`], at mean spacing 1.
pub fn sets() -> [PointSet; 2] {
    let plain = PointSet::new(table());
    let warped = plain.clone().seed(1);
    [plain, warped]
}

/// The points in a square of `side` with its lower corner at `min`.
pub fn boxed(set: &PointSet, min: [f64; 2], side: f64) -> Plan {
    let region = Region::new(min, min.map(|v| v + side)).expect("ordered");
    set.within(region).expect("in range")
}

/// Makes all points of a plan in a reused block. Returns the number of points.
pub fn fill_all<F: Format>(plan: &Plan, buffer: &mut [F::Item]) -> u64 {
    let mut blocks = plan.blocks::<F>();
    let mut total = 0;
    loop {
        let filled = blocks.fill(buffer);
        black_box(&mut *buffer);
        total += filled as u64;
        if filled < buffer.len() {
            return total;
        }
    }
}

/// Seconds per unit of work of each job, as the median over interleaved rounds. A job returns its
/// amount of work.
pub fn medians<const N: usize>(rounds: usize, jobs: &mut [&mut dyn FnMut() -> u64; N]) -> [f64; N] {
    let mut times: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    for _ in 0..rounds {
        for (job, times) in jobs.iter_mut().zip(&mut times) {
            let start = Instant::now();
            let amount = job();
            times.push(start.elapsed().as_secs_f64() / amount as f64);
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}
