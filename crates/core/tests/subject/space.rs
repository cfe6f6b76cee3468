//! Space, under the names that both dimensions have.

pub use strew_core::space::{
    Ball as Round, Blocks, Cursor, Format, Neighbor, Plan, Point, PointId, Region, SpaceSet as Set,
    Volume as Area,
};
use strew_core::{
    Error, F32, Map,
    server::Stop,
    space::Table,
    table::{Provenance, Ranks},
};
pub use ways::*;

#[path = "ways.rs"]
mod ways;

pub const D: usize = 3;

pub fn id([x, y, z]: [i64; D]) -> PointId {
    PointId { x, y, z }
}

pub fn placed(id: PointId, [x, y, z]: [f64; D]) -> Point {
    Point { id, x, y, z }
}

/// A table of a small map with arbitrary vectors of up to `most` and ranks.
pub fn table(most: i32) -> Table {
    let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 5).expect("small");
    let blocks = map.intervals().pow(3);
    let part = |v: usize| ((v % (2 * most as usize)) as i32 - most) as i16;
    let vector = |i: usize| [7919, 104_729, 1_299_709].map(|f| part(i * f));
    let vectors = (0..blocks).map(vector).collect();
    let order = (0..blocks as u32).map(|i| i * 11 % blocks as u32).collect();
    let ranks = Ranks::new(order).expect("an order");
    Table::new(map, "test", vectors, Provenance::default(), Some(ranks)).expect("valid")
}

/// A plan of an exact number of points, down to a spacing.
pub fn exactly(set: &Set, count: u128, area: &Area, least: f64) -> Result<Plan, Error> {
    set.exactly(count, area.clone(), least, &Stop::default())
}

/// The order of points.
pub fn order(id: PointId) -> impl Ord {
    (id.x >> 10, id.y >> 10, id.z, id.y, id.x)
}

/// Many places are found at once, and offsets in f32 are near.
pub fn agree_otherwise(plan: &Plan, points: &[Point], parts: Parts) {
    let numbers: Vec<u128> = (0..u128::from(parts.number)).map(|i| i * i * 37).collect();
    let cursors = plan.window(3, None).cursors(&numbers);
    let ids = cursors.iter().map(|cursor| cursor.map(|cursor| cursor.at));
    let expected = numbers.iter().map(|&k| points.get(k as usize + 3));
    assert!(ids.eq(expected.map(|point| point.map(|point| point.id))));
    let origin = plan.origin();
    for (point, single) in points.iter().zip(all::<F32>(plan, parts.block)) {
        for axis in 0..D {
            let offset = point.at()[axis] - origin[axis];
            let allowed = 1e-6 * (1.0 + offset.abs()) + point.at()[axis].abs() * 4.5e-16;
            assert!((f64::from(single[axis]) - offset).abs() <= allowed);
        }
    }
}
