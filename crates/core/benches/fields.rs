//! The speed of sets in fields, compared with thinned sets in the same run.
//!
//! `cargo bench -p strew-core --bench fields` prints medians of interleaved rounds: rasters of 512² pixels over
//! 2000² spacings, constant shares, a mask of 16384² pixels of which 1 % is 1, and cold boxes; all of it without
//! settling, and by two and three steps.

use std::{cell::Cell, hint::black_box};

use rounds::{Turns, fill_all, filling, micros, size, timed};
use strew_core::{
    Error, F32, PointSet, Raster, Region,
    field::{Edges, FieldSpec, Filter, Marks, Noise, Pixels},
};

mod rounds;

const BLOCK: usize = 4096;

fn square(side: f64) -> Region {
    Region::new([0.0, 0.0], [side, side]).expect("ordered")
}

/// Pixels that fall from 1 at the left by some octaves, over a square.
fn ramp(side: f64, octaves: f64) -> Raster {
    let pixel = |i: usize| (-octaves * (i % 512) as f64 / 511.0).exp2() as f32;
    Raster::new(square(side), 512, (0..512 * 512).map(pixel).collect()).expect("shares")
}

/// The same in 8 bits.
fn ramp_of_bytes(side: f64) -> Raster {
    let pixels = (0..512 * 512).map(|i| (255 - i % 512 / 2) as u8).collect();
    Raster::of(square(side), Pixels::from_bytes(512, pixels).expect("rows")).expect("shares")
}

/// A mask of `size`² pixels, a hundredth of which lie in disks.
fn mask(size: usize, side: f64) -> Raster {
    let mut pixels = vec![0u8; size * size];
    let radius = size as f64 * (0.01 / (4.0 * std::f64::consts::PI)).sqrt();
    for [x, y] in [[0.2, 0.3], [0.7, 0.25], [0.4, 0.8], [0.85, 0.7]] {
        let [x, y] = [x, y].map(|v| v * size as f64);
        for row in (y - radius) as usize..(y + radius) as usize {
            let half = (radius * radius - (row as f64 - y).powi(2)).max(0.0).sqrt();
            let (from, to) = ((x - half) as usize, (x + half) as usize);
            pixels[row * size + from..row * size + to].fill(255);
        }
    }
    let pixels = Pixels::from_bytes(size, pixels).expect("rows");
    let raster = Raster::of(square(side), pixels).expect("shares");
    raster.edges(Edges::Zero).filter(Filter::Nearest)
}

fn main() {
    let side = size(2000.0, 200.0);
    for steps in [0, 2, 3] {
        println!("settle={steps}");
        let set = PointSet::blue().seed(5).settle(steps).expect("0 to 4");
        rates(&set, side, if steps == 0 { 7 } else { 3 });
        for (name, octaves) in [("1 to 1/4", 2.0), ("1 to 1/32", 5.0)] {
            cold(&set, side, name, octaves);
        }
        masked(&set);
        let exactly = || set.in_field(ramp(side, 2.0)).exactly(100_000, square(side));
        let (plan, seconds) = timed(|| exactly().expect("near"));
        let (count, millis) = (plan.count(), 1e3 * seconds);
        println!("{count} points exactly in {millis:.1} ms");
    }
}

fn rates(set: &PointSet, side: f64, rounds: usize) {
    let noise = Noise {
        seed: 1,
        wavelength: 50.0,
        octaves: 4,
        range: [0.0, 1.0],
    };
    let vertex = |i: i32| {
        let along = f64::from(i) * side / 199.0;
        [along, side / 2.0 + 50.0 * f64::from(i % 7)]
    };
    let road = Marks::Lines(vec![(0..200).map(vertex).collect()]);
    let of = |field: Result<FieldSpec, Error>| set.in_field(field.expect("valid"));
    let half_and_ramp = vec![
        FieldSpec::constant(0.5).expect("valid"),
        FieldSpec::ramp([0.0, 0.0], [side / 4.0, 0.0], [1.0, 0.0]).expect("valid"),
    ];
    let thinned = set.clone().keep(0.5).expect("a share");
    let flat = set.clone().warp(0.0).expect("off");
    let shape = FieldSpec::ramp([0.0; 2], [side, 0.0], [1.0, 0.25]);
    let by_road = FieldSpec::distance(road, [5.0, 20.0], [0.0, 1.0]);
    let plans = [
        ("thinned to 1/2", thinned),
        ("constant 1/2", of(FieldSpec::constant(0.5))),
        (
            "1/2 in seven eighths of a ramp",
            of(FieldSpec::max(half_and_ramp)),
        ),
        ("raster, ramp 1 to 1/4", set.in_field(ramp(side, 2.0))),
        ("raster, ramp 1 to 1/32", set.in_field(ramp(side, 5.0))),
        (
            "raster of bytes, ramp 1 to 0",
            set.in_field(ramp_of_bytes(side)),
        ),
        ("shape, ramp 1 to 1/4", of(shape)),
        ("noise of four octaves", of(FieldSpec::noise(noise))),
        ("road of 200 vertices", of(by_road)),
        ("raster, ramp, no warp", flat.in_field(ramp(side, 2.0))),
    ]
    .map(|(name, set)| (name, set.within(square(side)).expect("near")));
    let mut turns = Turns::new(rounds);
    for (name, plan) in &plans {
        let name = format!("{name}, {} points", plan.count());
        turns.case(name, filling::<F32>(plan, BLOCK));
    }
    let title = format!("{side}² spacings, f32, blocks of {BLOCK}, one core");
    turns.run().print(title, &[("M points/s", &|s| 1e-6 / s)]);
}

/// Boxes of some 1,000 points, each elsewhere, whose plan is new.
fn cold(set: &PointSet, side: f64, name: &str, octaves: f64) {
    const BOXES: usize = 200;
    let graded = set.in_field(ramp(side, octaves));
    let (number, counted) = (Cell::new(0), Cell::new(0));
    let one = || {
        let i = f64::from(number.replace(number.get() + 1));
        let corner = [0.3 * side + i % 17.0, 0.2 * side + i * 2.0];
        let share = (-octaves * (corner[0] + 20.0) / side).exp2();
        let wide = (1000.0 / share).sqrt();
        let region = Region::new(corner, corner.map(|v| v + wide)).expect("ordered");
        let plan = graded.within(region).expect("near");
        let mut points = vec![[0f32; 2]; plan.count() as usize];
        counted.set(counted.get() + plan.blocks_f32().fill(&mut points));
        black_box(points);
        1
    };
    let name = format!("cold box, ramp {name}");
    let times = Turns::new(BOXES).case(name, one).run();
    let title = format!("{} points a box", counted.get() / number.get() as usize);
    times.print(title, &[("µs", &micros)]);
}

fn masked(set: &PointSet) {
    let size = size(16384, 1024);
    let (mask, seconds) = timed(|| mask(size, size as f64));
    println!("mask of {size}² pixels made ready in {seconds:.2} s");
    let graded = set.in_field(mask);
    for part in [0.25, 1.0] {
        let region = square(size as f64 * part);
        let (plan, counted) = timed(|| graded.within(region).expect("near"));
        let (_, filled) = timed(|| fill_all::<F32>(&plan, &mut vec![[0f32; 2]; BLOCK]));
        let candidates = || graded.candidates(region, 8192).expect("near");
        let (candidates, estimated) = timed(candidates);
        let [counted, filled, estimated] = [counted, filled, estimated].map(|v| 1e3 * v);
        println!(
            "mask, {part} of its side: {} points, counted in {counted:.1} ms, filled in {filled:.1} ms, {candidates} candidates in {estimated:.2} ms",
            plan.count(),
        );
    }
}
