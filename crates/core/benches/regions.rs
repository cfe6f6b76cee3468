//! Small boxes with a cold plan, circles and polygons, compared with the bulk rate of a box.

use std::hint::black_box;

use rounds::{BLOCK, boxed, fill_all, is_quick, medians, now, sets};
use strew_core::{Area, Circle, F32, Polygon};

mod rounds;

/// A polygon of 100 vertices around the origin, alternately at `radius` and `near * radius`. With
/// `near` 0.8 it is a star whose outline is almost four times as long as a circle's.
fn star(radius: f64, near: f64) -> Polygon {
    let vertex = |i: i32| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 100.0).sin_cos();
        let radius = if i % 2 == 0 { radius } else { near * radius };
        [radius * cos, radius * sin]
    };
    Polygon::new(&[(0..100).map(vertex).collect::<Vec<_>>()]).expect("a ring")
}

fn main() {
    let quick = is_quick();
    let points = if quick { 1e4 } else { 1e7f64 };
    let rounds = if quick { 1 } else { 15 };
    let sets = sets();
    let mut block = vec![[0f32; 2]; BLOCK];

    // Planning is timed too.
    let bulk = |block: &mut [[f32; 2]]| {
        let plan = boxed(&sets[0], [0.0, 0.0], points.sqrt());
        fill_all::<F32>(&plan, block)
    };
    let area = |area: Area, block: &mut [[f32; 2]]| {
        let plan = sets[0].within(area).expect("in range");
        fill_all::<F32>(&plan, block)
    };
    let radius = (points / std::f64::consts::PI).sqrt();
    let mut number = 0;
    let mut small = |set: usize, block: &mut [[f32; 2]]| {
        let boxes = if quick { 10 } else { 1000 };
        let mut total = 0;
        for _ in 0..boxes {
            number += 1;
            let at = [
                f64::from(number % 997) * 40.0,
                f64::from(number / 997) * 40.0,
            ];
            let plan = boxed(&sets[set], at, 31.6);
            let count = plan.count() as usize;
            let filled = plan.blocks_f32().fill(&mut block[..count]);
            black_box(&mut *block);
            total += filled as u64;
        }
        total
    };
    let mut blocks = [(); 4].map(|()| block.clone());
    let [one, two, three, four] = &mut blocks;
    let mut cold = vec![];
    let mut warped = vec![];
    let result = medians(
        rounds,
        &mut [
            &mut || bulk(one),
            &mut || area(Circle::new([0.0, 0.0], radius).expect("valid").into(), two),
            &mut || area(star(radius, 1.0).into(), three),
            &mut || area(star(radius / 0.9, 0.8).into(), four),
            &mut || {
                let start = now();
                let made = small(0, &mut block);
                cold.push((now() - start) / made as f64);
                let start = now();
                let made = small(1, &mut block);
                warped.push((now() - start) / made as f64);
                made
            },
        ],
    );
    println!("{points:e} points of f32, one core, plans included, median of {rounds}");
    let names = [
        "box",
        "circle",
        "regular, 100 vertices",
        "star, 100 vertices",
    ];
    for (name, seconds) in names.iter().zip(result) {
        let rate = 1e-9 / seconds;
        println!(
            "{name:<26} {rate:>12.3} G points/s {:>8.2} ÷ box",
            result[0] / seconds
        );
    }
    println!("boxes of 1,000 points, each elsewhere");
    for (name, mut seconds) in [("plain", cold), ("warped", warped)] {
        seconds.sort_by(f64::total_cmp);
        let each = seconds[seconds.len() / 2] * 1e9;
        let bulk = result[0] * 1e9;
        println!("{name:<26} {each:>8.2} µs a box; 1,000 points in bulk {bulk:>6.2} µs");
    }
}
