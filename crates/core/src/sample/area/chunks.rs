//! The chunks that an area lies in.
//!
//! Membership of a chunk is exact, which reported coordinates cannot decide. So the chunks of an area are
//! taken out of it: integers decide these, and the rest of the area is decided on coordinates.

use alloc::vec::Vec;

use super::{Area, Region, region::Chunk};

impl Area {
    /// The chunks of which the area is the intersection with [`beside_chunks`](Self::beside_chunks).
    pub(crate) fn chunks(&self) -> Vec<Chunk> {
        match self {
            Self::Region(region) => region.as_chunk().into_iter().collect(),
            Self::AllOf(areas) => areas.iter().flat_map(Self::chunks).collect(),
            _ => Vec::new(),
        }
    }

    /// The area without the restriction to its [`chunks`](Self::chunks); `None` if nothing else restricts
    /// it.
    pub(crate) fn beside_chunks(&self) -> Option<Self> {
        match self {
            Self::Region(region) if region.as_chunk().is_some() => None,
            Self::AllOf(areas) => {
                let mut rest: Vec<Self> = areas.iter().filter_map(Self::beside_chunks).collect();
                if rest.len() > 1 {
                    Some(Self::AllOf(rest))
                } else {
                    rest.pop()
                }
            }
            other => Some(other.clone()),
        }
    }

    /// The area with its [`chunks`](Self::chunks) as boxes that hold every point of them by its reported
    /// coordinates, and a little more.
    pub(crate) fn around_chunks(&self) -> Self {
        match self {
            Self::Region(region) if region.as_chunk().is_some() => {
                // Corners and reported coordinates are each rounded once.
                let below = |v: f64| v.next_down().next_down();
                let above = |v: f64| v.next_up().next_up();
                let (min, max) = (region.min().map(below), region.max().map(above));
                Self::Region(Region::between(min, max))
            }
            Self::AllOf(areas) => Self::AllOf(areas.iter().map(Self::around_chunks).collect()),
            other => other.clone(),
        }
    }
}
