//! What the tests of the sampler ask: tables of arbitrary vectors, seeds, and all points of a plan.

#![allow(dead_code, reason = "each test takes what it needs")]

use std::sync::Arc;

use proptest::prelude::*;
use strew_core::{
    Alpha, Map, Placement, Plan, Point, Sampler, Seed, Spacing, Table, Warp,
    sample::{Backend, Format},
    table::{FRACTION_BITS, Provenance},
};

const ALPHAS: [&str; 3] = ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"];

/// A table with arbitrary vectors up to about ±13 grid units, as long as any published one's.
pub fn table(alpha: &str, radius: u32) -> Table {
    let map = Map::new(alpha.parse::<Alpha>().expect("valid"), radius).expect("small");
    let blocks = map.intervals() * map.intervals();
    let mut state = 0x1234_5678_9abc_def0u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % (26 << FRACTION_BITS)) as i32 - (13 << FRACTION_BITS)
    };
    let vectors = (0..blocks).map(|_| [next(), next()]).collect();
    Table::new(map, "test", vectors, Provenance::default()).expect("valid")
}

/// Unit spacing with a seed and its default warp.
pub fn unit(seed: u64) -> Placement {
    Placement::new(Spacing::new(1.0).expect("valid"), Seed(seed))
}

pub fn samplers() -> &'static [Arc<Sampler>; 3] {
    static ONCE: std::sync::OnceLock<[Arc<Sampler>; 3]> = std::sync::OnceLock::new();
    ONCE.get_or_init(|| ALPHAS.map(|alpha| Arc::new(Sampler::new(table(alpha, 20)))))
}

pub fn all<F: Format>(plan: &Plan, block: usize) -> Vec<F::Item> {
    all_by::<F>(plan, block, Backend::best())
}

pub fn all_by<F: Format>(plan: &Plan, block: usize, backend: Backend) -> Vec<F::Item> {
    let mut blocks = plan.blocks::<F>().with_backend(backend);
    let mut buffer = vec![F::Item::default(); block];
    let mut items = Vec::new();
    loop {
        let filled = blocks.fill(&mut buffer);
        items.extend_from_slice(&buffer[..filled]);
        if filled < block {
            return items;
        }
    }
}

pub fn in_order_of_ids(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by_key(|p| (p.id.x.div_euclid(1024), p.id.y, p.id.x));
    points
}

pub fn any_sampler() -> impl Strategy<Value = Arc<Sampler>> {
    (0..3usize).prop_map(|i| samplers()[i].clone())
}

pub fn any_seed() -> impl Strategy<Value = (Seed, Warp)> {
    let seed = prop_oneof![Just(Seed(0)), any::<u64>().prop_map(Seed)];
    let strength = (0.0..2.0f64).prop_map(|s| Warp::new(s).expect("in range"));
    (
        seed,
        prop_oneof![2 => Just(Warp::OFF), 2 => Just(Warp::ON), 1 => strength],
    )
}
