//! Located in the points of a source, of the plane and of space alike.

use strew_core::{Cursor, PointId, space};

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
