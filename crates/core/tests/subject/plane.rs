//! The plane, under the names that both dimensions have.

pub use strew_core::{
    Area, Blocks, Circle as Round, Cursor, Format, Neighbor, Plan, Point, PointId, PointSet as Set,
    Region,
};
use strew_core::{Error, F32, Points, server::Stop};
pub use ways::*;

#[path = "ways.rs"]
mod ways;

pub const D: usize = 2;

pub fn id([x, y]: [i64; D]) -> PointId {
    PointId { x, y }
}

pub fn placed(id: PointId, [x, y]: [f64; D]) -> Point {
    Point { id, x, y }
}

/// The order of points.
pub fn order(id: PointId) -> impl Ord {
    (id.x.div_euclid(1024), id.y, id.x)
}

/// Tiles of any length have the points, and blocks of pairs know where they are.
pub fn agree_otherwise(plan: &Plan, points: &[Point], parts: Parts) {
    let tiles = plan.tiles(parts.tile);
    let made = tiles.flat_map(|tile| read(plan.tile_blocks::<Points>(&tile), 100));
    assert!(made.eq(points.iter().copied()));
    let mut blocks = plan.blocks::<F32>();
    assert!(blocks.cursor().is_some() || points.is_empty());
    let filled = blocks.fill(&mut vec![[0.0; 2]; parts.block]);
    assert!(blocks.cursor().is_some() || filled == points.len());
    if let Some(cursor) = blocks.cursor() {
        let next = plan.from_cursor(cursor).window(0, Some(70)).to_vec();
        assert_eq!(next, points[filled..points.len().min(filled + 70)]);
    }
    // No claim but that it ends.
    if let Some(cursor) = blocks.cursor() {
        let stop = Stop::new();
        stop.raise();
        let stopped = plan.from_cursor(cursor).stopped_by(stop);
        let _ = stopped.window(3, None).next_cursor();
    }
}

/// A plan of an exact number of points, down to a spacing.
pub fn exactly(set: &Set, count: u128, area: &Area, least: f64) -> Result<Plan, Error> {
    set.exactly_until(count, area.clone(), least, &Stop::default())
}

/// Checks searches around a place against a box.
pub fn agree_around(set: &Set, at: [f64; D], radius: f64) {
    let mut expected = in_box(set, at, radius.max(0.1));
    let is_near = expected.iter().any(|near| near.0 < radius * radius);
    expected.retain(|near| near.0 <= radius * radius);
    let expected: Vec<Point> = expected.into_iter().map(|near| near.1).collect();
    let points =
        |near: Vec<Neighbor>| -> Vec<Point> { near.iter().map(|n| n.member.point()).collect() };
    let found = set.around(at, radius, 10_000).expect("few");
    assert_eq!(points(found), expected);
    let few = expected.len().min(20);
    if few > 0 {
        let nearest = set.nearest(at, few).expect("enough");
        assert_eq!(points(nearest), expected[..few]);
    }
    if radius > 0.0 {
        let mut clearance = set.clearance(radius).expect("few");
        assert_eq!(clearance.is_any_near(at, |_| true), is_near);
    }
}
