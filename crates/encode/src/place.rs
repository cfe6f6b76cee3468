//! Places of the plane and of space alike: what coordinates are relative to, and how exactly they are wanted.
//!
//! Rows have a [`Point`] each, with the first two coordinates of its id and of its place. Points in space have a
//! [`Height`] beside it, which formats see as the column `z` and as the last part of ids.

use serde::Serialize;
use strew_core::{Cursor, Point, PointId, space};

use crate::{output::Output, source::Source};

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
    /// The coordinates that an output wants, where its parts have a lower `corner`.
    pub fn of(output: &Output, corner: impl FnOnce() -> Place) -> Self {
        match (output.encoding, output.relative_to) {
            (encoding, origin) if encoding.is_near() => Self::Near(origin.unwrap_or_else(corner)),
            (encoding, Some(origin)) if !encoding.is_picture() => Self::Relative(origin),
            _ => Self::World,
        }
    }

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

/// Moves the points of a plan. Rounding never takes one out of the moved region: what would reach
/// its upper bound takes the number before.
pub(super) struct Shift {
    origin: [f64; 3],
    bound: [f64; 3],
}

impl Shift {
    pub(super) fn new(plan: &dyn Source, origin: Place) -> Self {
        let [max_x, max_y] = plan.region().max();
        let max = [max_x, max_y, plan.heights().map_or(0.0, |[_, top]| top)];
        let [x, y] = origin.flat();
        let origin = [x, y, origin.z()];
        Self {
            origin,
            bound: [0, 1, 2].map(|axis| max[axis] - origin[axis]),
        }
    }

    pub(super) fn apply(&self, point: &Point) -> [f64; 2] {
        [self.moved(point.x, 0), self.moved(point.y, 1)]
    }

    /// The coordinate along z.
    pub(super) fn height(&self, z: f64) -> f64 {
        self.moved(z, 2)
    }

    fn moved(&self, value: f64, axis: usize) -> f64 {
        let moved = value - self.origin[axis];
        if moved < self.bound[axis] {
            moved
        } else {
            self.bound[axis].next_down()
        }
    }

    pub(super) fn near(&self, point: &Point) -> [f32; 2] {
        let [x, y] = self.apply(point);
        [self.narrowed(x, 0), self.narrowed(y, 1)]
    }

    /// The coordinate along z as `f32`.
    pub(super) fn near_height(&self, z: f64) -> f32 {
        self.narrowed(self.height(z), 2)
    }

    fn narrowed(&self, value: f64, axis: usize) -> f32 {
        let near = value as f32;
        if f64::from(near) < self.bound[axis] {
            near
        } else {
            near.next_down()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample_rows::parts;

    #[test]
    fn what_rounds_up_to_the_bound_takes_the_number_before() {
        let plan = &parts()[0].plan;
        let shift = Shift::new(&**plan, Place::Plane(plan.origin()));
        let last = Point {
            x: 30f64.next_down(),
            y: 40.5f64.next_down(),
            ..Point::default()
        };
        assert_eq!(shift.near(&last), [40f32.next_down(), 35.5f32.next_down()]);
    }
}
