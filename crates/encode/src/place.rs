//! Places of the plane and of space alike.

use serde::Serialize;

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
