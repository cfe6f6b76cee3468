//! Cursors: places in the order of a selection's points.

use super::PointId;

/// A place in the order of a selection's points: before the point `at`, after `offset` others.
///
/// It belongs to one selection; with it the rest is found without counting again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cursor {
    /// How many points come before.
    pub offset: u128,
    /// How many points there are in all.
    pub total: u128,
    /// The lattice address of the next point.
    pub at: PointId,
}
