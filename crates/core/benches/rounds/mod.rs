//! Shared code of the benches: a table, medians of interleaved rounds, and filling a whole plan.

#![allow(dead_code, reason = "each bench takes what it needs")]

use std::{hint::black_box, sync::LazyLock, time::Instant};

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
    table_of(49)
}

/// A table of a neighborhood with random displacements: 49 for the map s, 100 for m and 200 for l.
pub fn table_of(radius: u32) -> Table {
    let map = Map::new("(5-sqrt(3))/2".parse::<Alpha>().expect("valid"), radius).expect("small");
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

/// The time that this thread has run, in seconds; elsewhere than on Unix the time of day. Others on the machine
/// take little of it.
pub fn now() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }
    #[cfg(not(unix))]
    time_of_day()
}

/// The time since the first call, in seconds: for work of several threads.
pub fn time_of_day() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

/// Seconds of this thread per unit of work of each job, as the median over interleaved rounds. A job returns
/// its amount of work.
pub fn medians<const N: usize>(rounds: usize, jobs: &mut [&mut dyn FnMut() -> u64; N]) -> [f64; N] {
    medians_by(now, rounds, jobs)
}

/// [`medians`] by another clock.
pub fn medians_by<const N: usize>(
    clock: fn() -> f64,
    rounds: usize,
    jobs: &mut [&mut dyn FnMut() -> u64; N],
) -> [f64; N] {
    let mut times: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    for _ in 0..rounds {
        for (job, times) in jobs.iter_mut().zip(&mut times) {
            let start = clock();
            let amount = job();
            times.push((clock() - start) / amount as f64);
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}
