//! What the tests of point sets share: tables of arbitrary vectors, seeds, and all points of a plan.

#![allow(dead_code, reason = "each test uses what it needs")]

pub mod definition;
pub mod mixed;

use std::path::Path;

use proptest::prelude::*;
use strew_core::{
    Alpha, Backend, Format, Map, Placement, Plan, Point, PointSet, Seed, Spacing, Table, Warp,
    table::{FRACTION_BITS, Provenance},
};

const ALPHAS: [&str; 3] = ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"];

/// A table with arbitrary vectors up to about ±13 grid units, as long as those of published tables. That of the
/// golden ratio has the profile `pink`, and with it the long waves of the warp.
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
    let profile = if alpha.contains("sqrt(5)") {
        "pink"
    } else {
        "test"
    };
    Table::new(map, profile, vectors, Provenance::default()).expect("valid")
}

/// Unit spacing with a seed and its default warp.
pub fn unit(seed: u64) -> Placement {
    Placement::new(Spacing::new(1.0).expect("valid"), Seed(seed))
}

/// A table of arbitrary vectors for each α, made once.
pub fn tables() -> &'static [Table; 3] {
    static ONCE: std::sync::OnceLock<[Table; 3]> = std::sync::OnceLock::new();
    ONCE.get_or_init(|| ALPHAS.map(|alpha| table(alpha, 20)))
}

/// A table of the repository, by the name of its file without the ending.
pub fn shipped(name: &str) -> Table {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = format!("{name}.strew");
    let places = [root.join("tables"), root.join("../catalog/tables")];
    let found = places
        .iter()
        .find_map(|place| std::fs::read(place.join(&file)).ok());
    Table::from_bytes(&found.expect("there")).expect("valid")
}

/// The set of a table at a placement.
pub fn set(table: &Table, placement: Placement) -> PointSet {
    PointSet::new(table.clone()).placed(placement)
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

pub fn any_table() -> impl Strategy<Value = Table> {
    (0..3usize).prop_map(|i| tables()[i].clone())
}

pub fn any_seed() -> impl Strategy<Value = (Seed, Warp)> {
    let seed = prop_oneof![Just(Seed(0)), any::<u64>().prop_map(Seed)];
    let strength = (0.0..2.0f64).prop_map(|s| Warp::new(s).expect("in range"));
    (
        seed,
        prop_oneof![2 => Just(Warp::OFF), 2 => Just(Warp::ON), 1 => strength],
    )
}
