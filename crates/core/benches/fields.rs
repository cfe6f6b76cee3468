//! The speed of sets in fields, compared with thinned sets in the same run.
//!
//! `cargo bench -p strew-core --bench fields` prints medians of interleaved rounds: rasters of 512² pixels over
//! 2000² spacings, constant shares, a mask of 16384² pixels of which 1 % is 1, and cold boxes; all of it without
//! settling, and by two and three steps.

use std::{hint::black_box, time::Instant};

use rounds::{fill_all, is_quick, medians, now};
use strew_core::{
    F32, Field, Plan, PointSet, Raster, Region,
    field::{Edges, FieldSpec, Filter, Marks, Noise, Pixels},
    server,
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

fn within(set: &PointSet, field: impl Field + 'static, region: Region) -> Plan {
    set.in_field(field).within(region).expect("near")
}

fn main() {
    for steps in [0, 2, 3] {
        println!("settle={steps}");
        measure(steps);
    }
}

fn measure(steps: u32) {
    let (side, size, rounds) = match steps {
        _ if is_quick() => (200.0, 1024, 1),
        0 => (2000.0, 16384, 7),
        _ => (2000.0, 16384, 3),
    };
    let region = square(side);
    let set = PointSet::blue().seed(5).settle(steps).expect("0 to 4");
    let noise = Noise {
        seed: 1,
        wavelength: 50.0,
        octaves: 4,
        range: [0.0, 1.0],
    };
    let road: Vec<[f64; 2]> = (0..200)
        .map(|i| {
            [
                f64::from(i) * side / 199.0,
                side / 2.0 + 50.0 * f64::from(i % 7),
            ]
        })
        .collect();
    let spec = |spec: Result<FieldSpec, strew_core::Error>| spec.expect("valid");
    let half_and_ramp = spec(FieldSpec::max(vec![
        spec(FieldSpec::constant(0.5)),
        spec(FieldSpec::ramp([0.0, 0.0], [side / 4.0, 0.0], [1.0, 0.0])),
    ]));
    let plans = [
        (
            "thinned to 1/2",
            set.clone()
                .keep(0.5)
                .expect("a share")
                .within(region)
                .expect("near"),
        ),
        (
            "constant 1/2",
            within(&set, spec(FieldSpec::constant(0.5)), region),
        ),
        (
            "1/2 in seven eighths of a ramp",
            within(&set, half_and_ramp, region),
        ),
        (
            "raster, ramp 1 to 1/4",
            within(&set, ramp(side, 2.0), region),
        ),
        (
            "raster, ramp 1 to 1/32",
            within(&set, ramp(side, 5.0), region),
        ),
        (
            "raster of bytes, ramp 1 to 0",
            within(&set, ramp_of_bytes(side), region),
        ),
        (
            "shape, ramp 1 to 1/4",
            within(
                &set,
                spec(FieldSpec::ramp([0.0; 2], [side, 0.0], [1.0, 0.25])),
                region,
            ),
        ),
        (
            "noise of four octaves",
            within(&set, spec(FieldSpec::noise(noise)), region),
        ),
        (
            "road of 200 vertices",
            within(
                &set,
                spec(FieldSpec::distance(
                    Marks::Lines(vec![road]),
                    [5.0, 20.0],
                    [0.0, 1.0],
                )),
                region,
            ),
        ),
        (
            "raster, ramp, no warp",
            within(
                &set.clone().warp(0.0).expect("off"),
                ramp(side, 2.0),
                region,
            ),
        ),
    ];
    let mut blocks = vec![vec![[0f32; 2]; BLOCK]; plans.len()];
    let mut jobs: Vec<Box<dyn FnMut() -> u64>> = vec![];
    for ((_, plan), block) in plans.iter().zip(&mut blocks) {
        jobs.push(Box::new(move || fill_all::<F32>(plan, block)));
    }
    let mut jobs: Vec<&mut dyn FnMut() -> u64> =
        jobs.iter_mut().map(|job| &mut **job as _).collect();
    let jobs: &mut [_; 10] = jobs.as_mut_slice().try_into().expect("ten");
    let result = medians(rounds, jobs);
    println!("{side}² spacings, f32, blocks of {BLOCK}, one core, median of {rounds}");
    for ((name, plan), seconds) in plans.iter().zip(result) {
        let count = plan.count();
        println!(
            "{name:<32} {:>8.1} M points/s  {count} points",
            1e-6 / seconds
        );
    }

    // Each box is elsewhere, and its plan is new.
    for (name, octaves) in [("1 to 1/4", 2.0), ("1 to 1/32", 5.0)] {
        let graded = set.in_field(ramp(side, octaves));
        let mut times = vec![];
        let mut counted = 0;
        for i in 0..200 {
            let corner = [
                0.3 * side + f64::from(i % 17),
                0.2 * side + f64::from(i) * 2.0,
            ];
            let share = (-octaves * (corner[0] + 20.0) / side).exp2();
            let wide = (1000.0 / share).sqrt();
            let region = Region::new(corner, corner.map(|v| v + wide)).expect("ordered");
            let start = now();
            let plan = graded.within(region).expect("near");
            let mut points = vec![[0f32; 2]; plan.count() as usize];
            counted += plan.blocks_f32().fill(&mut points);
            times.push(now() - start);
            black_box(points);
        }
        times.sort_by(f64::total_cmp);
        println!(
            "cold box of {} points, ramp {name}: {:.1} µs",
            counted / times.len(),
            1e6 * times[times.len() / 2]
        );
    }

    let start = Instant::now();
    let mask = mask(size, size as f64);
    println!(
        "mask of {size}² pixels made ready in {:.2} s",
        start.elapsed().as_secs_f64()
    );
    let graded = set.in_field(mask);
    for part in [0.25, 1.0] {
        let region = square(size as f64 * part);
        let start = Instant::now();
        let plan = graded.within(region).expect("near");
        let counted = start.elapsed().as_secs_f64();
        let start = Instant::now();
        fill_all::<F32>(&plan, &mut vec![[0f32; 2]; BLOCK]);
        let filled = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let candidates = server::candidates(&graded, region, 8192).expect("near");
        let estimated = start.elapsed().as_secs_f64();
        println!(
            "mask, {part} of its side: {} points, counted in {:.1} ms, filled in {:.1} ms, {candidates} candidates in {:.2} ms",
            plan.count(),
            1e3 * counted,
            1e3 * filled,
            1e3 * estimated
        );
    }
    let start = Instant::now();
    let plan = set
        .in_field(ramp(side, 2.0))
        .exactly(100_000, region)
        .expect("near");
    println!(
        "{} points exactly in {:.1} ms",
        plan.count(),
        1e3 * start.elapsed().as_secs_f64()
    );
}
