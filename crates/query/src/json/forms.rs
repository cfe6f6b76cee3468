//! The shapes that regions have, in the plane and in space.

use strew_catalog::Dimension;

use super::super::{region::REGION, volume::VOLUME};

/// The shapes that regions of one kind have.
pub(super) struct Forms {
    /// Their names, each a member.
    pub(super) names: [&'static str; 5],
    /// All of them in words.
    pub(super) allowed: &'static str,
    pub(super) dimension: Dimension,
}

impl Forms {
    /// Those of the plane.
    pub(super) const PLANE: Self = Self {
        names: ["bbox", "circle", "polygon", "chunk", "include"],
        allowed: REGION,
        dimension: Dimension::Plane,
    };
    /// Those of space.
    pub(super) const SPACE: Self = Self {
        names: ["bbox", "ball", "prism", "chunk", "include"],
        allowed: VOLUME,
        dimension: Dimension::Space,
    };

    /// Those of a dimension.
    pub(super) const fn of(dimension: Dimension) -> &'static Self {
        match dimension {
            Dimension::Plane => &Self::PLANE,
            Dimension::Space => &Self::SPACE,
        }
    }
}
