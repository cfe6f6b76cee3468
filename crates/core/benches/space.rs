//! Points in space, with the figures of the plane in the same rounds.
//!
//! `-- --quick` only checks that everything still runs.

use std::hint::black_box;

use rounds::{BLOCK, Turns, drain, filling, giga, in_block, micros, numbers, sets, size};
use strew_core::{
    F32, F64, Map,
    space::{Format, Plan, Region, SpaceSet, Table},
    table::Provenance,
};

mod rounds;

/// A table of 21 intervals with random vectors of up to 1.5 spacings along each axis.
fn table() -> Table {
    let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 16).expect("small");
    let numbers = numbers();
    let next = || (((numbers() >> 40) % 40_000) as i32 - 20_000) as i16;
    let vectors = (0..map.intervals().pow(3)).map(|_| [next(), next(), next()]);
    let vectors = vectors.collect();
    Table::new(map, "bench", vectors, Provenance::default(), None).expect("valid")
}

fn cube(set: &SpaceSet, min: f64, side: f64) -> Plan {
    let region = Region::new([min; 3], [min + side; 3]).expect("ordered");
    set.within(region).expect("in range")
}

fn fill_space<F: Format>(plan: &Plan, block: &mut [F::Item]) -> u64 {
    let mut blocks = plan.blocks::<F>();
    drain(block, |block| blocks.fill(block))
}

fn filling_space<F: Format>(plan: &Plan) -> impl FnMut() -> u64 {
    in_block(BLOCK, move |block| fill_space::<F>(plan, block))
}

/// A job that plans and makes a box, each elsewhere.
fn cold_box(set: &SpaceSet) -> impl FnMut() -> u64 {
    let mut at = 0.0;
    in_block(2000, move |block| {
        at += 1.37;
        fill_space::<F32>(&cube(set, at, 10.0), block);
        1
    })
}

fn main() {
    let side = size(160.0, 20.0);
    let plain = SpaceSet::new(table());
    let seeded = plain.clone().seed(1);
    let [plane, _] = sets();
    let area = rounds::boxed(&plane, [0.0; 2], side * 12.0);
    let [all, warped] = [&plain, &seeded].map(|set| cube(set, 3.0, side));
    Turns::new(9)
        .case("plane f32 (baseline)", filling::<F32>(&area, BLOCK))
        .case("space f32 (>= 1.0)", filling_space::<F32>(&all))
        .case("space f64", filling_space::<F64>(&all))
        .case("space f32, seeded (>= 0.25)", filling_space::<F32>(&warped))
        .run()
        .print("one core", &[("G points/s", &giga)]);

    let ids: Vec<_> = cube(&seeded, 0.0, 10.0).iter().map(|p| p.id()).collect();
    let by_id = |set: &SpaceSet| {
        black_box(ids.iter().filter_map(|id| set.point(*id)).count());
        ids.len() as u64
    };
    let mut turns = Turns::new(401);
    let name = "cold box of 1,000 points";
    turns.case(format!("{name} (<= 25)"), cold_box(&plain));
    turns.case(format!("{name}, seeded (<= 60)"), cold_box(&seeded));
    for side in [1e3, 1e6, 1e9] {
        let plain = &plain;
        let count = move || {
            black_box(cube(plain, -side / 2.0, side).count());
            1
        };
        turns.case(format!("plain count, side {side:e} (<= 50)"), count);
    }
    turns.case("point by id, seeded (<= 0.5)", || by_id(&seeded));
    turns.case("point by id, plain (<= 0.5)", || by_id(&plain));
    turns.run().print("one core", &[("us", &micros)]);
}
