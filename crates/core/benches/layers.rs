//! Chunks of layers: trees clear of rocks, and grass clear of both, counted and made.

use rounds::{fill_all, is_quick, medians};
use strew_core::{F64, Plan, Point, PointSet, Points, Region};

mod rounds;

/// The side of a chunk.
const SIDE: f64 = 64.0;

fn main() {
    let quick = is_quick();
    let (rounds, chunks) = if quick { (1, 2) } else { (25, 40) };
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

    let mut number = 0;
    // Each chunk elsewhere.
    let mut made = |set: &PointSet, block: &mut [Point]| {
        for _ in 0..chunks {
            number += 1;
            let plan = set.chunk(SIDE, [number % 211, number / 211]);
            let plan = plan.expect("in range");
            fill_all::<Points>(&plan, block);
        }
        chunks as u64
    };
    let mut blocks = [(); 5].map(|()| vec![Point::default(); 8192]);
    let [one, two, three, four, five] = &mut blocks;
    let sets = [&trees, &clear_trees, &grass, &clear_grass, &sparse];
    let made = std::cell::RefCell::new(&mut made);
    let chunk = |i: usize, block: &mut [Point]| (made.borrow_mut())(sets[i], block);
    let times = medians(
        rounds,
        &mut [
            &mut || chunk(0, one),
            &mut || chunk(1, two),
            &mut || chunk(2, three),
            &mut || chunk(3, four),
            &mut || chunk(4, five),
        ],
    );
    println!("chunks of {SIDE}, each elsewhere: counted and made; median of {rounds}");
    let names = [
        "trees",
        "trees clear of rocks",
        "grass",
        "grass clear of rocks and trees",
        "a few points clear of grass",
    ];
    for ((name, set), seconds) in names.iter().zip(sets).zip(times) {
        let points = mean(set);
        let each = seconds * 1e6;
        println!("{name:<32} {points:>7.0} points {each:>9.1} µs");
    }

    // Large plans, made piece by piece.
    let side = if quick { 200.0 } else { 2000.0 };
    let plan = |set: &PointSet| -> Plan {
        let region = Region::new([0.0; 2], [side; 2]).expect("ordered");
        set.within(region).expect("in range")
    };
    let plans = [plan(&clear_trees), plan(&clear_grass)];
    let mut block = vec![[0.0; 2]; 8192];
    let mut other = block.clone();
    let times = medians(
        rounds.min(5),
        &mut [&mut || fill_all::<F64>(&plans[0], &mut block), &mut || {
            fill_all::<F64>(&plans[1], &mut other)
        }],
    );
    println!("squares of {side}, counted before");
    for ((name, plan), seconds) in [names[1], names[3]].iter().zip(&plans).zip(times) {
        let (points, each) = (plan.count(), seconds * 1e9);
        println!("{name:<32} {points:>7} points {each:>9.1} ns a point");
    }
}

/// The mean number of points in a chunk.
fn mean(set: &PointSet) -> f64 {
    let region = Region::new([0.0; 2], [4.0 * SIDE; 2]).expect("ordered");
    set.count(region).expect("in range") as f64 / 16.0
}
