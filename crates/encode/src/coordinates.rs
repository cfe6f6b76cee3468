//! The origin and the precision of an answer's coordinates.

use serde::Serialize;

use crate::output::Output;

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
    #[must_use]
    pub const fn as_slice(&self) -> &[f64] {
        match self {
            Self::Plane(at) => at,
            Self::Space(at) => at,
        }
    }

    /// Its first two coordinates.
    #[must_use]
    pub const fn flat(self) -> [f64; 2] {
        match self {
            Self::Plane(at) => at,
            Self::Space([x, y, _]) => [x, y],
        }
    }

    /// Its coordinate along z, 0 in the plane.
    #[must_use]
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
    #[must_use]
    pub fn of(output: &Output, corner: impl FnOnce() -> Place) -> Self {
        match (output.encoding, output.relative_to) {
            (encoding, origin) if encoding.is_near() => Self::Near(origin.unwrap_or_else(corner)),
            (encoding, Some(origin)) if !encoding.is_picture() => Self::Relative(origin),
            _ => Self::World,
        }
    }

    /// The origin of the coordinates, if it is not the world's.
    #[must_use]
    pub const fn origin(self) -> Option<Place> {
        match self {
            Self::World => None,
            Self::Relative(origin) | Self::Near(origin) => Some(origin),
        }
    }
}
