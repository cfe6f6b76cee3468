//! Space, under the names that both dimensions have.

use strew_core::F32;
pub use strew_core::space::{
    Ball as Round, Blocks, Cursor, Format, Neighbor, Plan, Point, PointId, Region, SpaceSet as Set,
    Volume as Area,
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

/// The order of points.
pub fn order(id: PointId) -> impl Ord {
    (id.x >> 10, id.y >> 10, id.z, id.y, id.x)
}

pub fn found(neighbor: &Neighbor) -> Point {
    neighbor.point
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
            assert!((f64::from(single[axis]) - offset).abs() <= 1e-6 * (1.0 + offset.abs()));
        }
    }
}
