//! The third coordinate of points in space.
//!
//! Rows have a [`Point`] each, with the first two coordinates of its id and of its place. Points in space have a
//! [`Height`] beside it, which formats see as the column `z` and as the last part of ids.

use strew_core::{Point, PointId, space};

/// The third coordinate of a point: that of its lattice address and that of its place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Height {
    /// The lattice coordinate along z.
    pub address: i64,
    /// The coordinate along z, in world units.
    pub z: f64,
}

/// Some points with their heights.
#[derive(Clone, Copy, Debug)]
pub struct Located<'a> {
    /// The points.
    pub points: &'a [Point],
    /// The height of each of them in space; empty in the plane.
    pub heights: &'a [Height],
}

impl<'a> Located<'a> {
    /// A point in space in two parts.
    pub const fn parted(point: &space::Point) -> (Point, Height) {
        let space::Point { id, x, y, z } = *point;
        let flat = Point {
            id: PointId { x: id.x, y: id.y },
            x,
            y,
        };
        (flat, Height { address: id.z, z })
    }

    /// The points in space.
    pub fn in_space(self) -> impl ExactSizeIterator<Item = space::Point> + 'a {
        let pairs = self.points.iter().zip(self.heights);
        pairs.map(|(point, height)| space::Point {
            id: space::PointId {
                x: point.id.x,
                y: point.id.y,
                z: height.address,
            },
            x: point.x,
            y: point.y,
            z: height.z,
        })
    }
}
