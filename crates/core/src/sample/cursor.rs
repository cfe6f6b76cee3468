//! Cursors: places in the order of a request's points.

use super::lattice::PointId;

/// A place in the order of a request's points. [`PointSet::resume`](crate::PointSet::resume) finds the
/// points from there on without counting.
///
/// It belongs to one request. With another one, the points of that from the lattice address on are found,
/// with the numbers of the cursor.
///
/// ```
/// use strew_core::{Cursor, PointId, PointSet, Region, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let (set, region) = (PointSet::new(table), Region::chunk(20.0, [0, 0])?);
/// let plan = set.within(region)?;
/// let cursor = plan.window(0, Some(100)).next_cursor().expect("there are more");
/// // Its parts can be sent to a client and come back with the next request.
/// let Cursor { offset, total, at: PointId { x, y } } = cursor;
/// assert_eq!((offset, total), (100, plan.count()));
/// let back = Cursor { offset, total, at: PointId { x, y } };
/// assert_eq!(set.resume(region, back)?.to_vec(), plan.to_vec()[100..]);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cursor {
    /// The number of points before the place.
    pub offset: u128,
    /// The number of points of the request.
    pub total: u128,
    /// The lattice address of the next point.
    pub at: PointId,
}
