//! The origin and the precision of an answer's coordinates.

use crate::{output::Output, place::Place};

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
