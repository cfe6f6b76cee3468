//! scratch
use std::sync::Arc;
use strew_core::{sample::*, table::Provenance, *};
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
fn run<F: Format>(plan: &Plan) -> u64 {
    let mut b = plan.blocks::<F>();
    let mut buf = vec![F::Item::default(); 65536];
    let mut n = 0;
    loop {
        let f = b.fill(&mut buf);
        std::hint::black_box(&mut buf);
        n += f as u64;
        if f < buf.len() {
            return n;
        }
    }
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let seed: u64 = a[2].parse().unwrap();
    let reps: u32 = a[3].parse().unwrap();
    let s = Arc::new(Sampler::new(table()));
    let r = Region::new([0.0, 0.0], [5477.0, 5477.0]).unwrap();
    let plan = s
        .plan(Placement::new(Spacing::new(1.0).unwrap(), Seed(seed)), r)
        .unwrap();
    let t = std::time::Instant::now();
    let mut n = 0;
    for _ in 0..reps {
        n += match a[1].as_str() {
            "f32" => run::<F32>(&plan),
            "f64" => run::<F64>(&plan),
            _ => run::<Points>(&plan),
        };
    }
    println!(
        "{} {:.3} G/s",
        n,
        n as f64 / t.elapsed().as_secs_f64() / 1e9
    );
}
