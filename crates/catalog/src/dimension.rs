//! Tables of the plane and of space.

use std::fmt;

/// Where the points of a table lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Dimension {
    /// In the plane.
    #[default]
    Plane,
    /// In space.
    Space,
}

impl Dimension {
    /// The number of coordinates of a point.
    #[must_use]
    pub const fn axes(self) -> u32 {
        match self {
            Self::Plane => 2,
            Self::Space => 3,
        }
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Plane => "plane",
            Self::Space => "space",
        })
    }
}
