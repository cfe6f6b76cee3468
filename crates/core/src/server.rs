//! What a server needs beside the points: what a request will cost, before the work, and a way to stop
//! counting when its client has left.
//!
//! ```
//! use strew_core::{Circle, ErrorKind, PointSet, Table, server::{self, Stop}};
//!
//! # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
//! let (set, circle) = (PointSet::new(table), Circle::new([0.0, 0.0], 500.0)?);
//! let stop = Stop::new();
//! assert!(server::within(&set, circle, &stop).is_ok());
//! // From another thread, while the counting goes on:
//! stop.raise();
//! let stopped = server::within(&set, circle, &stop).unwrap_err();
//! assert_eq!(stopped.kind(), ErrorKind::Stopped);
//! # Ok::<(), strew_core::Error>(())
//! ```

use crate::{
    error::Error,
    sample::{Area, Plan, PointSet, Region},
};

pub use crate::sample::Stop;

/// [`PointSet::within`], whose counting stops once the flag is raised.
///
/// # Errors
/// As [`PointSet::within`], and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
pub fn within(set: &PointSet, area: impl Into<Area>, stop: &Stop) -> Result<Plan, Error> {
    set.within_until(area.into(), stop.clone())
}

/// [`PointSet::exactly`] without spacings below `least`, whose counting stops once the flag is raised.
/// Where counting takes time in proportion to the lattice rows, `least` bounds it.
///
/// # Errors
/// As [`PointSet::exactly`], and [`ErrorKind::TooDense`](crate::ErrorKind::TooDense) or
/// [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
pub fn exactly(
    set: &PointSet,
    count: u128,
    area: &Area,
    least: f64,
    stop: &Stop,
) -> Result<Plan, Error> {
    set.exactly_until(count, area, least, stop)
}

/// The plan with another flag: its windows and cursors, which may have to count, stop once that is raised.
/// What they return then is meaningless.
#[must_use]
pub fn stopped_by(plan: Plan, stop: Stop) -> Plan {
    plan.with_stop(stop)
}

/// About half the length, along the axes, of the outlines of all shapes of an area inside `within`: width
/// + height for a box. Counting an area takes time in proportion to this and to its height.
#[must_use]
pub fn outline(area: &Area, within: Region) -> f64 {
    area.outline(within)
}

/// The sum, over strips of a height from the bottom of `within` up, of the [`outline`] in the strip times
/// the number of edges, boxes and circles that touch it. Points beside an outline are compared with all
/// of these, so it is what an area of many edges costs besides.
///
/// Takes time in proportion to the edges and to the outline in strips. There are at most 65,536 strips,
/// higher ones if need be.
#[must_use]
pub fn comparisons(area: &Area, within: Region, strip: f64) -> f64 {
    area.comparisons(within, strip)
}
