//! Cursors: places in the order of a request's points.

use super::lattice::PointId;

/// A place in the order of a request's points. [`PointSet::resume`](crate::PointSet::resume) finds the
/// points from there on without counting.
///
/// It belongs to one request. With another one, the points of that from the lattice address on are found,
/// with the numbers of the cursor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cursor {
    /// The number of points before the place.
    pub offset: u128,
    /// The number of points of the request.
    pub total: u128,
    /// The lattice address of the next point.
    pub at: PointId,
}
