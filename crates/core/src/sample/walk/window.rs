//! Windows: parts of the points of a scope, by their order.

use crate::sample::lattice::PointId;

/// A part of the points of a scope: from a place on, up to a number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    /// The lattice address of the first point, unless that is the scope's first.
    pub(crate) start: Option<PointId>,
    /// The number of points before the window.
    pub(crate) offset: u128,
    /// The number of points of the window.
    pub(crate) count: u128,
    /// The number of points of the scope.
    pub(crate) total: u128,
}
