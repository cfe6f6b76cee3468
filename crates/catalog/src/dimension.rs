//! Tables of the plane and of space.

use std::fmt;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Dimension {
    #[default]
    Plane,
    Space,
}

impl Dimension {
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
