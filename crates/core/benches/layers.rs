//! Chunks of layers: trees clear of rocks, and grass clear of both, counted and made.

use rounds::{Turns, elsewhere, fill_all, filling, in_block, micros, size};
use strew_core::{F64, Plan, PointSet, Points, Region};

mod rounds;

/// The side of a chunk.
const SIDE: f64 = 64.0;

fn square(set: &PointSet, side: f64) -> Plan {
    rounds::boxed(set, [0.0; 2], side)
}

fn main() {
    let set = |spacing: f64, seed: u64| {
        let set = PointSet::blue().spacing(spacing);
        set.expect("in range").seed(seed)
    };
    let rocks = set(16.0, 1);
    let trees = set(4.0, 2);
    // 3,000 points in a chunk.
    let grass = set(SIDE / 3000f64.sqrt(), 3);
    let clear = |set: &PointSet, of: &PointSet, distance: f64| {
        let clear = set.clone().clear_of(of, distance);
        clear.expect("near enough")
    };
    let clear_trees = clear(&trees, &rocks, 3.0);
    let clear_grass = clear(&clear(&grass, &rocks, 2.0), &clear_trees, 1.0);
    let sparse = clear(&set(64.0, 4), &grass, 1.0);
    let sets = [
        ("trees", trees),
        ("trees clear of rocks", clear_trees),
        ("grass", grass),
        ("grass clear of rocks and trees", clear_grass),
        ("a few points clear of grass", sparse),
    ];
    let chunks = size(40, 2);
    let mut turns = Turns::new(25);
    for (name, set) in &sets {
        // The mean of a chunk.
        let points = square(set, 4.0 * SIDE).count() as f64 / 16.0;
        let elsewhere = elsewhere();
        let made = in_block(8192, move |block| {
            for _ in 0..chunks {
                let region = Region::chunk(SIDE, elsewhere()).expect("in range");
                fill_all::<Points>(&set.within(region).expect("in range"), block);
            }
            chunks
        });
        turns.case(format!("{name}, {points:.0} points"), made);
    }
    let title = format!("chunks of {SIDE}, each elsewhere: counted and made");
    turns.run().print(title, &[("µs", &micros)]);

    // Large plans, made piece by piece.
    let side = size(2000.0, 200.0);
    let plans = [&sets[1], &sets[3]].map(|(name, set)| (name, square(set, side)));
    let mut turns = Turns::new(5);
    for (name, plan) in &plans {
        let name = format!("{name}, {} points", plan.count());
        turns.case(name, filling::<F64>(plan, 8192));
    }
    let title = format!("squares of {side}, counted before");
    turns.run().print(title, &[("ns a point", &|s| 1e9 * s)]);
}
