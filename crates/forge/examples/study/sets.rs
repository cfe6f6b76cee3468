//! Points of squares.

use strew_core::{Point, PointSet, Region};

use crate::Outcome;

/// The corner of squares that are drawn, away from the origin.
pub const CORNER: [f64; 2] = [12_345.0, -6_789.0];

/// The points of a square, from its corner.
pub fn square(set: &PointSet, corner: [f64; 2], side: f64) -> Outcome<Vec<Point>> {
    let region = Region::new(corner, corner.map(|v| v + side))?;
    let mut points = set.within(region)?.to_vec();
    for point in &mut points {
        (point.x, point.y) = (point.x - corner[0], point.y - corner[1]);
    }
    Ok(points)
}

/// Where points are.
pub fn places(points: &[Point]) -> Vec<[f64; 2]> {
    points.iter().map(Point::at).collect()
}
