//! Cursors: places in the order of a request's points.

use super::point::PointId;

/// A place in the order of a request's points. [`SpaceSet::resume`](super::SpaceSet::resume) finds the points from there
/// on without counting. It belongs to one request.
///
/// ```
/// use strew_core::space::{Region, SpaceSet, Table};
///
/// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
/// let region = Region::chunk(20.0, [0, 0, 0])?;
/// let plan = set.within(region)?;
/// let cursor = plan.window(0, Some(100)).next_cursor().expect("there are more");
/// assert_eq!((cursor.offset, cursor.total), (100, plan.count()));
/// assert_eq!(set.resume(region, cursor)?.to_vec(), plan.to_vec()[100..]);
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
