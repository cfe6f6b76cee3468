//! The needs of a server beside the points: the cost of a request before the work, and a way to stop
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

use alloc::vec::Vec;
use core::ops::Range;

use crate::{
    Raster,
    error::Error,
    field::{FieldSpec, Terrain},
    lattice::Spacing,
    map::Clusters,
    pattern::Alpha,
    periodic::{PeriodicPlan, PeriodicSet},
    plan::Plan,
    set::{Neighbor, PointSet},
    shape::{Area, Region},
    window::Windowed as _,
};

pub use crate::{near::Visits, stop::Stop};

/// Runs [`Clusters::new`], which stops once the flag is raised. The search looks at the flag for each block.
///
/// # Errors
/// As [`Clusters::new`], and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
pub fn clusters(alpha: Alpha, distance: f64, most: usize, stop: &Stop) -> Result<Clusters, Error> {
    Clusters::until(alpha, distance, most, stop)
}

/// Runs [`PointSet::within`], whose counting stops once the flag is raised.
///
/// # Errors
/// As [`PointSet::within`], and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
pub fn within(set: &PointSet, area: impl Into<Area>, stop: &Stop) -> Result<Plan, Error> {
    set.within_until(area.into(), stop.clone())
}

/// Runs [`PointSet::exactly`] without spacings below `least`; its counting stops once the flag is raised.
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

/// Runs [`PointSet::kind_counts`], whose counting stops once the flag is raised.
///
/// # Errors
/// As [`PointSet::kind_counts`], and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
pub fn kind_counts(set: &PointSet, area: impl Into<Area>, stop: &Stop) -> Result<Vec<u128>, Error> {
    set.kind_counts_until(&area.into(), stop)
}

/// Runs [`PeriodicSet::plan`], whose counting stops once the flag is raised.
///
/// # Errors
/// [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
pub fn period(set: &PeriodicSet, stop: &Stop) -> Result<PeriodicPlan, Error> {
    set.plan_until(stop)
}

/// The number of points of each kind in a period, the rarest kind first; empty for a table without kinds.
///
/// # Errors
/// [`ErrorKind::Stopped`](crate::ErrorKind::Stopped) once the flag is raised.
pub fn kinds_of_period(set: &PeriodicSet, stop: &Stop) -> Result<Vec<u64>, Error> {
    set.kind_counts_until(stop)
}

/// Estimates the number of points that [`within`] visits one by one to count the points of a set in a
/// [field](PointSet::in_field). Making the points visits them again. The estimate cuts the area's box into up to
/// `pieces` pieces, looks up the field's bounds for each, and multiplies the points at full density there by the
/// greatest share. It is 0 for sets in no field.
///
/// # Errors
/// As [`PointSet::within`].
pub fn candidates(set: &PointSet, area: impl Into<Area>, pieces: usize) -> Result<u128, Error> {
    set.candidates(area.into(), pieces)
}

/// Estimates the nanoseconds that a look at a field takes on a processor of some years ago: the mean over a few places
/// of a region. It counts steps and reads no clock, so every machine returns the same number.
#[must_use]
pub fn look(field: &FieldSpec, within: Region) -> f64 {
    field.nanoseconds(within)
}

/// The columns and rows of the lattice that hold all points of an area, and a few more around it: an id beyond them
/// is no point there.
///
/// # Errors
/// As [`PointSet::within`].
pub fn addresses(set: &PointSet, area: impl Into<Area>) -> Result<[Range<i64>; 2], Error> {
    set.addresses(area.into())
}

/// Runs [`PointSet::nearest`], or [`PointSet::nearest_within`] if there is a radius, and visits a bounded number of
/// points.
///
/// # Errors
/// As those, [`ErrorKind::TooMany`](crate::ErrorKind::TooMany) where more points would have to be visited, and
/// [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
pub fn nearest(
    set: &PointSet,
    at: [f64; 2],
    k: usize,
    radius: Option<f64>,
    visits: &Visits,
) -> Result<Vec<Neighbor>, Error> {
    set.nearest_visiting(at, k, radius, visits)
}

/// Runs [`PointSet::around`] and visits a bounded number of points.
///
/// # Errors
/// As [`PointSet::around`], [`ErrorKind::TooMany`](crate::ErrorKind::TooMany) where more points would have to be
/// visited, and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
pub fn around(
    set: &PointSet,
    at: [f64; 2],
    radius: f64,
    limit: usize,
    visits: &Visits,
) -> Result<Vec<Neighbor>, Error> {
    set.around_visiting(at, radius, limit, visits)
}

/// Runs [`FieldSpec::slope`], which ends early once the flag is raised.
///
/// # Errors
/// As [`FieldSpec::slope`], and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
pub fn slope(
    terrain: Terrain,
    slopes: [f64; 2],
    shares: [f64; 2],
    stop: &Stop,
) -> Result<FieldSpec, Error> {
    FieldSpec::slope_unless(terrain, [slopes, shares], stop)
}

/// Runs [`Raster::tone`], which ends early once the flag is raised.
///
/// # Errors
/// As [`Raster::tone`], and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
pub fn tone(raster: Raster, low: f64, high: f64, gamma: f64, stop: &Stop) -> Result<Raster, Error> {
    raster.tone_unless([low, high, gamma], stop)
}

/// Returns the plan with another flag. Its windows and cursors may have to count, and stop once that flag is raised.
/// Their results are then meaningless.
#[must_use]
pub fn stopped_by(plan: Plan, stop: Stop) -> Plan {
    plan.with_stop(stop)
}

/// Cuts a plan into windows that begin at the given ascending offsets. Each window ends where the next begins, and the
/// last one at the end of the plan. Where finding a place takes time proportional to the rows, many windows take
/// little longer than one.
#[must_use]
pub fn windows(plan: &Plan, offsets: &[u128]) -> Vec<Plan> {
    plan.windows_at(offsets, plan.count())
}

/// The bytes of the points and places that counting has kept in a plan, beside its area.
#[must_use]
pub fn kept(plan: &Plan) -> usize {
    plan.kept()
}

/// Returns the plan without the points and places that counting has kept. It finds them again, which takes time.
#[must_use]
pub fn forgetting(plan: Plan) -> Plan {
    plan.forgetting()
}

/// A sparser or denser set of the same table and seed in the area of a plan, whatever its window and
/// share, clear of the same other sets. Its points are not counted: [`Plan::count`] is only a bound.
///
/// A picture whose pixels are larger than the spacing can show this set in place of the plan.
///
/// # Errors
/// [`ErrorKind::Spacing`](crate::ErrorKind::Spacing) outside of [`Spacing`]'s range, and as
/// [`PointSet::within`].
pub fn preview(plan: &Plan, spacing: f64) -> Result<Plan, Error> {
    plan.with_spacing(Spacing::new(spacing)?)
}

/// The number of steps by which the points of a set settle, 0 if they stay.
#[must_use]
pub fn steps(set: &PointSet) -> u32 {
    set.steps()
}

/// About how long a set's points settle near an outline, in steps of a set without kinds; 0 if they do not. Points of
/// kinds push each other twice and reach farther.
#[must_use]
pub fn settling(set: &PointSet) -> f64 {
    set.settling()
}

/// A bound of the share of points that a set has in a box: its share, times that of its field.
#[must_use]
pub fn greatest_share(set: &PointSet, within: &Region) -> f64 {
    set.greatest_share(within)
}

/// About half the length, along the axes and in world units, of the outlines of all shapes of an area
/// inside `within`: width + height for a box. Counting an area takes time in proportion to this and to
/// its height.
#[must_use]
pub fn outline(area: &Area, within: Region) -> f64 {
    area.outline(within)
}

/// About how many comparisons of points with sides of polygons, boxes and circles it takes to count an area inside
/// `within`, at this spacing: points beside an outline are compared with all sides near them. A further cost of areas with
/// many sides. Takes time in proportion to them and to the outline.
#[must_use]
pub fn comparisons(area: &Area, within: Region, spacing: Spacing) -> f64 {
    /// About the lattice units in a mean spacing.
    const UNITS: f64 = 3.0;
    area.comparisons(within, spacing.get() / UNITS)
}
