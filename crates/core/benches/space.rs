//! Points in space, with the figures of the plane in the same rounds.
//!
//! `-- --quick` only checks that everything still runs.

use std::hint::black_box;

use rounds::{BLOCK, fill_all, is_quick, medians, now, sets};
use strew_core::{
    F32, Map,
    space::{Format, Plan, Region, SpaceSet, Table},
    table::Provenance,
};

mod rounds;

/// A table of 21 intervals with random vectors of up to 1.5 spacings along each axis.
fn table() -> Table {
    let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 16).expect("small");
    let mut state = 1u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((state >> 40) % 40_000) as i32 - 20_000
    };
    let vectors =
        (0..map.intervals().pow(3)).map(|_| [next() as i16, next() as i16, next() as i16]);
    let vectors = vectors.collect();
    Table::new(map, "bench", vectors, Provenance::default(), None).expect("valid")
}

fn cube(set: &SpaceSet, min: f64, side: f64) -> Plan {
    let region = Region::new([min; 3], [min + side; 3]).expect("ordered");
    set.within(region).expect("in range")
}

fn fill_space<F: Format>(plan: &Plan, buffer: &mut [F::Item]) -> u64 {
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

fn row(name: &str, value: f64, unit: &str, target: &str) {
    println!("{name:<44} {value:>10.3} {unit:<10} {target}");
}

fn main() {
    let (side, rounds) = if is_quick() { (20.0, 1) } else { (160.0, 9) };
    let plain = SpaceSet::new(table());
    let seeded = plain.clone().seed(1);
    let [plane, _] = sets();
    let area = rounds::boxed(&plane, [0.0; 2], f64::from(side as f32) * 12.0);
    let [all, warped] = [&plain, &seeded].map(|set| cube(set, 3.0, side));
    let mut pairs = vec![[0f32; 2]; BLOCK];
    let (mut triples, mut others) = (vec![[0f32; 3]; BLOCK], vec![[0f32; 3]; BLOCK]);
    let mut doubles = vec![[0f64; 3]; BLOCK];
    let found = medians(
        rounds,
        &mut [
            &mut || fill_all::<F32>(&area, &mut pairs),
            &mut || fill_space::<F32>(&all, &mut triples),
            &mut || fill_space::<strew_core::F64>(&all, &mut doubles),
            &mut || fill_space::<F32>(&warped, &mut others),
        ],
    );
    let speed = |seconds: f64| 1e-9 / seconds;
    row("plane f32 (baseline)", speed(found[0]), "G points/s", "");
    row("space f32", speed(found[1]), "G points/s", ">= 1.0");
    row("space f64", speed(found[2]), "G points/s", "");
    row(
        "space f32, seeded",
        speed(found[3]),
        "G points/s",
        ">= 0.25",
    );

    let mut small = vec![[0f32; 3]; 2000];
    let mut at = 0.0;
    let mut cold = |set: &SpaceSet| {
        at += 1.37;
        let plan = cube(set, at, 10.0);
        fill_space::<F32>(&plan, &mut small);
        1
    };
    let few = if is_quick() { 3 } else { 401 };
    let times = |job: &mut dyn FnMut() -> u64| {
        let mut times: Vec<f64> = (0..few)
            .map(|_| {
                let start = now();
                job();
                1e6 * (now() - start)
            })
            .collect();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    row(
        "cold box of 1,000 points",
        times(&mut || cold(&plain)),
        "us",
        "<= 25",
    );
    row(
        "cold box of 1,000 points, seeded",
        times(&mut || cold(&seeded)),
        "us",
        "<= 60",
    );
    for side in [1e3, 1e6, 1e9] {
        let mut count = || black_box(cube(&plain, -side / 2.0, side).count()) as u64;
        row(
            &format!("plain count, side {side:e}"),
            times(&mut count),
            "us",
            "<= 50",
        );
    }
    let ids: Vec<_> = cube(&seeded, 0.0, 10.0)
        .iter()
        .map(|point| point.id)
        .collect();
    let mut by_id = || ids.iter().filter_map(|id| seeded.point(*id)).count() as u64;
    row(
        "point by id, seeded",
        times(&mut by_id) / ids.len() as f64,
        "us",
        "<= 0.5",
    );
    let mut by_id = || ids.iter().filter_map(|id| plain.point(*id)).count() as u64;
    row(
        "point by id, plain",
        times(&mut by_id) / ids.len() as f64,
        "us",
        "<= 0.5",
    );
}
