//! How fast a box is filled, beside the published row scanner and a plain fill, in one run.
//!
//! `cargo bench -p strew-core` prints medians of interleaved rounds and ratios; ratios hold on
//! noisy machines, absolute times do not. `cargo bench -p strew-core -- --quick` only checks that
//! everything still runs.

use std::{hint::black_box, sync::Arc, time::Instant};

use strew_core::{
    Alpha, Map, Placement, Plan, Region, Sampler, Seed, Spacing, Table,
    sample::{F32, F64, Format, Points},
    table::Provenance,
};

#[path = "baseline/row_scanner.rs"]
mod row_scanner;

/// Points per reused block: 512 KiB of f32 pairs.
const BLOCK: usize = 65_536;

fn table() -> Table {
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

fn fill_all<F: Format>(plan: &Plan, buffer: &mut [F::Item]) -> u64 {
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

/// Seconds per point of each job: the median over interleaved rounds.
fn medians<const N: usize>(rounds: usize, jobs: &mut [&mut dyn FnMut() -> u64; N]) -> [f64; N] {
    let mut times: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    for _ in 0..rounds {
        for (job, times) in jobs.iter_mut().zip(&mut times) {
            let start = Instant::now();
            let points = job();
            times.push(start.elapsed().as_secs_f64() / points as f64);
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}

fn main() {
    let quick = std::env::args().any(|arg| arg == "--quick" || arg == "--test");
    let (side, rounds) = if quick { (300.0, 1) } else { (5477.0, 9) };
    let table = table();
    let scanner = row_scanner::RowScanner::new(&table);
    let sampler = Arc::new(Sampler::new(table));
    let region = Region::new([0.0, 0.0], [side, side]).expect("ordered");
    let plan = sampler
        .plan(
            Placement::new(Spacing::new(1.0).expect("valid"), Seed(0)),
            region,
        )
        .expect("in range");
    let points = plan.count() as u64;
    let warped = sampler
        .plan(
            Placement::new(Spacing::new(1.0).expect("valid"), Seed(1)),
            region,
        )
        .expect("in range");

    let (mut f32s, mut f64s) = (vec![[0f32; 2]; BLOCK], vec![[0f64; 2]; BLOCK]);
    let (mut ids, mut plain) = (vec![Default::default(); BLOCK], vec![[0f32; 2]; BLOCK]);
    let mut scanned = vec![[0f32; 2]; BLOCK];
    let mut warped_f32s = vec![[0f32; 2]; BLOCK];
    let mut marker = 0f32;
    let result = medians(
        rounds,
        &mut [
            &mut || scanner.scan(side, &mut scanned),
            &mut || {
                for _ in 0..points.div_ceil(BLOCK as u64) {
                    marker += 1.0;
                    black_box(&mut plain).fill([marker, marker]);
                }
                points.next_multiple_of(BLOCK as u64)
            },
            &mut || fill_all::<F32>(&plan, &mut f32s),
            &mut || fill_all::<F64>(&plan, &mut f64s),
            &mut || fill_all::<F32>(&warped, &mut warped_f32s),
            &mut || fill_all::<Points>(&plan, &mut ids),
        ],
    );
    let names = [
        "row scanner, f32",
        "plain fill, f32",
        "box, f32",
        "box, f64",
        "box with warp, f32",
        "box, ids and f64",
    ];
    println!("{points} points, blocks of {BLOCK}, one core, median of {rounds}");
    println!(
        "{:<20} {:>12} {:>12} {:>12}",
        "", "G points/s", "÷ scanner", "÷ fill"
    );
    for (name, seconds) in names.iter().zip(result) {
        println!(
            "{name:<20} {:>12.3} {:>12.2} {:>12.2}",
            1e-9 / seconds,
            result[0] / seconds,
            result[1] / seconds
        );
    }
}
