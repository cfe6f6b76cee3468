//! Places of the plane and of space alike: what coordinates are relative to, and how exactly they are wanted.
//!
//! Rows have a [`Point`] each, with the first two coordinates of its id and of its place. Points in space have a
//! [`Height`] beside it, which formats see as the column `z` and as the last part of ids.

use serde::Serialize;
use strew_core::{Cursor, Point, PointId, space};

/// A place of the plane or of space, in world units, such as one that coordinates are relative to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Place {
    /// In the plane.
    Plane([f64; 2]),
    /// In space.
    Space([f64; 3]),
}

impl Place {
    /// Its coordinates: two in the plane, three in space.
    pub const fn as_slice(&self) -> &[f64] {
        match self {
            Self::Plane(at) => at,
            Self::Space(at) => at,
        }
    }

    /// Its first two coordinates.
    pub const fn flat(self) -> [f64; 2] {
        match self {
            Self::Plane(at) => at,
            Self::Space([x, y, _]) => [x, y],
        }
    }

    /// Its coordinate along z, 0 in the plane.
    pub const fn z(self) -> f64 {
        match self {
            Self::Plane(_) => 0.0,
            Self::Space([_, _, z]) => z,
        }
    }

    /// The lower corner of both together.
    pub(super) const fn least(self, other: Self) -> Self {
        let ([x, y], [other_x, other_y]) = (self.flat(), other.flat());
        let [x, y, z] = [x.min(other_x), y.min(other_y), self.z().min(other.z())];
        match self {
            Self::Plane(_) => Self::Plane([x, y]),
            Self::Space(_) => Self::Space([x, y, z]),
        }
    }
}

/// The origin of coordinates, and how exactly they are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinates {
    /// As they are in the world.
    World,
    /// Relative to a point. Where it is a plan's origin, offsets are exact at any distance.
    Relative(Place),
    /// As `f32` relative to a point, in `Batch::near`. Where it is a plan's origin, they come
    /// from the kernel.
    Near(Place),
}

impl Coordinates {
    /// The origin of the coordinates, if it is not the world's.
    pub const fn origin(self) -> Option<Place> {
        match self {
            Self::World => None,
            Self::Relative(origin) | Self::Near(origin) => Some(origin),
        }
    }
}

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

/// A place in the points of a source: where a later answer goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark {
    /// The number of points before it.
    pub offset: u128,
    /// The number of points of the whole.
    pub total: u128,
    /// The lattice address of the point there; the third coordinate is 0 in the plane.
    pub at: [i64; 3],
}

impl Mark {
    /// As a cursor of the plane.
    pub const fn in_plane(self) -> Cursor {
        let Self { offset, total, at } = self;
        let [x, y, _] = at;
        Cursor {
            offset,
            total,
            at: PointId { x, y },
        }
    }

    /// As a cursor in space.
    pub const fn in_space(self) -> space::Cursor {
        let Self { offset, total, at } = self;
        let [x, y, z] = at;
        space::Cursor {
            offset,
            total,
            at: space::PointId { x, y, z },
        }
    }
}

impl From<Cursor> for Mark {
    fn from(Cursor { offset, total, at }: Cursor) -> Self {
        let at = [at.x, at.y, 0];
        Self { offset, total, at }
    }
}

impl From<space::Cursor> for Mark {
    fn from(space::Cursor { offset, total, at }: space::Cursor) -> Self {
        let at = [at.x, at.y, at.z];
        Self { offset, total, at }
    }
}
