//! The shapes that regions have, in the plane and in space.

use strew_catalog::Dimension;

use super::super::{region::REGION, volume::VOLUME};

pub(super) struct Forms {
    pub(super) names: [&'static str; 5],
    pub(super) allowed: &'static str,
    pub(super) dimension: Dimension,
}

impl Forms {
    pub(super) const PLANE: Self = Self {
        names: ["bbox", "circle", "polygon", "chunk", "include"],
        allowed: REGION,
        dimension: Dimension::Plane,
    };
    pub(super) const SPACE: Self = Self {
        names: ["bbox", "ball", "prism", "chunk", "include"],
        allowed: VOLUME,
        dimension: Dimension::Space,
    };

    pub(super) const fn of(dimension: Dimension) -> &'static Self {
        match dimension {
            Dimension::Plane => &Self::PLANE,
            Dimension::Space => &Self::SPACE,
        }
    }
}
