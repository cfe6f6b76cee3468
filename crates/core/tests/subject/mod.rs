//! What the tests of point sets share: tables of arbitrary vectors, seeds, and all points of a plan.

#![allow(
    dead_code,
    unused_imports,
    clippy::duplicate_mod,
    reason = "each test uses what it needs, and both dimensions have the same ways"
)]

pub mod definition;
pub mod mixed;
pub mod plane;
pub mod space;

use std::path::Path;

pub use plane::{all, all_by};
use proptest::prelude::*;
use strew_core::{
    Alpha, Area, Circle, Error, Keep, Map, Placement, PointSet, Polygon, Region, Seed, Spacing,
    Table, Warp,
    field::{FieldSpec, Noise},
    table::{FRACTION_BITS, Provenance},
};

const ALPHAS: [&str; 3] = ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"];

/// A table with arbitrary vectors up to about ±13 grid units, as long as those of published tables.
pub fn table(alpha: &str, radius: u32) -> Table {
    table_of(alpha, radius, 13 << FRACTION_BITS)
}

/// A table with arbitrary vectors of up to `most`. That of the golden ratio has the profile `pink`, and with it the long
/// waves of the warp.
pub fn table_of(alpha: &str, radius: u32, most: i32) -> Table {
    let map = Map::new(alpha.parse::<Alpha>().expect("valid"), radius).expect("small");
    let blocks = map.intervals() * map.intervals();
    let mut state = 0x1234_5678_9abc_def0u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % (2 * most as u64)) as i32 - most
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

/// Arbitrary and published tables.
pub fn tables_of_searches() -> &'static [Table; 4] {
    static ONCE: std::sync::OnceLock<[Table; 4]> = std::sync::OnceLock::new();
    ONCE.get_or_init(|| {
        [
            table("sqrt(3)", 20),
            table("(1+sqrt(5))/2", 20),
            shipped("blue-5-sqrt3-over-2-s"),
            shipped("pink-5-sqrt3-over-2-s"),
        ]
    })
}

/// A set, and a place near or far.
pub fn any_place() -> impl Strategy<Value = (PointSet, [f64; 2])> {
    let place = prop_oneof![
        4 => -50.0..50.0f64,
        2 => -1e6..1e6f64,
        1 => -1e15..1e15f64,
        1 => Just(0.0),
    ];
    let seed = prop_oneof![1 => Just(0u64), 3 => any::<u64>()];
    let strength = prop_oneof![Just(0.0), Just(1.0), Just(2.0), 0.0..2.0f64];
    let spacing = prop_oneof![Just(1.0), 0.01..100.0f64, 1e-9..1e9f64];
    (0..4usize, seed, strength, spacing, place.clone(), place).prop_map(
        |(table, seed, strength, spacing, x, y)| {
            let warp = Warp::new(strength).expect("in range");
            let placement =
                Placement::new(Spacing::new(spacing).expect("valid"), Seed(seed)).with_warp(warp);
            let set = set(&tables_of_searches()[table], placement);
            (set, [x * spacing, y * spacing])
        },
    )
}

/// Seeds, strengths of the warp, spacings and shares.
pub fn any_placement() -> impl Strategy<Value = Placement> {
    let seed = prop_oneof![Just(0u64), any::<u64>()];
    let warp = prop_oneof![Just(0.0), Just(1.0), 0.0..2.0f64];
    let keep = prop_oneof![Just(1.0), 0.02..1.0f64, 0.2..1.0f64];
    (seed, warp, 0.6..3.0f64, keep).prop_map(|(seed, warp, spacing, keep)| {
        Placement::new(Spacing::new(spacing).expect("in range"), Seed(seed))
            .with_warp(Warp::new(warp).expect("in range"))
            .with_keep(Keep::new(keep).expect("a share"))
    })
}

pub fn any_box() -> impl Strategy<Value = Region> {
    let corner = prop::array::uniform2(-70.0..40.0f64);
    (corner, prop::array::uniform2(0.0..45.0f64))
        .prop_map(|([x, y], [w, h])| plane::between([x, y], [x + w, y + h]))
}

pub fn any_area() -> impl Strategy<Value = Area> {
    let center = || prop::array::uniform2(-30.0..30.0f64);
    let circle = || (center(), 1.0..25.0f64).prop_map(|(at, r)| Circle::new(at, r).expect("round"));
    let ring = prop::collection::vec(center(), 3..7);
    let chunk = (1.0..40.0f64, prop::array::uniform2(-3..3i64));
    prop_oneof![
        any_box().prop_map(Area::from),
        chunk.prop_map(|(size, at)| Region::chunk(size, at).expect("near").into()),
        circle().prop_map(Area::from),
        ring.prop_filter_map("a polygon", |ring| Polygon::new(&[ring])
            .ok()
            .map(Area::from)),
        (any_box(), circle())
            .prop_map(|(region, circle)| { Area::from(region).without([circle.into()]) }),
    ]
}

/// Noise of a seed, a wavelength, a number of octaves and a range.
pub fn noise(
    seed: u64,
    wavelength: f64,
    octaves: u32,
    range: [f64; 2],
) -> Result<FieldSpec, Error> {
    FieldSpec::noise(Noise {
        seed,
        wavelength,
        octaves,
        range,
    })
}

/// A field with places of share 0 and of share 1.
pub fn waves([x, y]: [f64; 2]) -> f64 {
    0.7 + 0.5 * (x * 0.2).sin() * (y * 0.1).cos()
}
