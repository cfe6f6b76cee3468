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
    map::Clusters,
    pattern::Alpha,
    sample::{Area, Neighbor, PeriodicPlan, PeriodicSet, Plan, PointSet, Region, Spacing},
};

pub use crate::sample::{Stop, Visits};

/// Runs [`Clusters::new`], which stops once the flag is raised. The search looks at the flag for each block.
///
/// # Errors
/// As [`Clusters::new`], and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
///
/// ```
/// use strew_core::{ErrorKind, server::{self, Stop}};
///
/// let stop = Stop::new();
/// let alpha = "sqrt(3)".parse()?;
/// assert_eq!(server::clusters(alpha, 2.0, 16, &stop)?.shapes().len(), 4);
/// stop.raise();
/// let error = server::clusters(alpha, 2.0, 16, &stop).unwrap_err();
/// assert_eq!(error.kind(), ErrorKind::Stopped);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub fn clusters(alpha: Alpha, distance: f64, most: usize, stop: &Stop) -> Result<Clusters, Error> {
    Clusters::until(alpha, distance, most, stop)
}

/// Runs [`PointSet::within`], whose counting stops once the flag is raised.
///
/// # Errors
/// As [`PointSet::within`], and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
///
/// ```
/// use strew_core::{PointSet, Region, Table, server::{self, Stop}};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let (set, region) = (PointSet::new(table), Region::chunk(64.0, [0, 0])?);
/// // A default flag is never raised, so the plan is the ordinary one.
/// let plan = server::within(&set, region, &Stop::default())?;
/// assert_eq!(plan.count(), set.count(region)?);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub fn within(set: &PointSet, area: impl Into<Area>, stop: &Stop) -> Result<Plan, Error> {
    set.within_until(area.into(), stop.clone())
}

/// Runs [`PointSet::exactly`] without spacings below `least`; its counting stops once the flag is raised.
/// Where counting takes time in proportion to the lattice rows, `least` bounds it.
///
/// # Errors
/// As [`PointSet::exactly`], and [`ErrorKind::TooDense`](crate::ErrorKind::TooDense) or
/// [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
///
/// ```
/// use strew_core::{ErrorKind, PointSet, Region, Table, server::{self, Stop}};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let (set, area) = (PointSet::new(table), Region::chunk(10.0, [0, 0])?.into());
/// let stop = Stop::new();
/// assert_eq!(server::exactly(&set, 100, &area, 0.5, &stop)?.count(), 100);
/// // 10⁶ points in a square of side 10 take a spacing of 0.01.
/// let error = server::exactly(&set, 1_000_000, &area, 0.5, &stop).unwrap_err();
/// assert_eq!((error.kind(), error.limit()), (ErrorKind::TooDense, Some(0.5)));
/// # Ok::<(), strew_core::Error>(())
/// ```
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
///
/// ```
/// use strew_core::{PointSet, Region, Table, server::{self, Stop}};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let region = Region::chunk(64.0, [0, 0])?;
/// // This table has no kinds.
/// assert!(server::kind_counts(&PointSet::new(table), region, &Stop::default())?.is_empty());
/// # Ok::<(), strew_core::Error>(())
/// ```
pub fn kind_counts(set: &PointSet, area: impl Into<Area>, stop: &Stop) -> Result<Vec<u128>, Error> {
    set.kind_counts_until(&area.into(), stop)
}

/// Runs [`PeriodicSet::plan`], whose counting stops once the flag is raised.
///
/// # Errors
/// [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
///
/// ```
/// use strew_core::{PeriodicSet, Table, server::{self, Stop}};
///
/// # let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 49, "pattern")?;
/// let tile = PeriodicSet::new(table, 5000)?;
/// assert_eq!(server::period(&tile, &Stop::default())?.count(), 5041);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub fn period(set: &PeriodicSet, stop: &Stop) -> Result<PeriodicPlan, Error> {
    set.plan_until(stop)
}

/// The number of points of each kind in a period, the rarest kind first; empty for a table without kinds.
///
/// # Errors
/// [`ErrorKind::Stopped`](crate::ErrorKind::Stopped) once the flag is raised.
///
/// ```
/// use strew_core::{PeriodicSet, Table, server::{self, Stop}};
///
/// # let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 49, "pattern")?;
/// let tile = PeriodicSet::new(table, 5000)?;
/// assert!(server::kinds_of_period(&tile, &Stop::default())?.is_empty());
/// # Ok::<(), strew_core::Error>(())
/// ```
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
///
/// ```
/// use strew_core::{PointSet, Region, Table, field::FieldSpec, server};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let set = PointSet::new(table);
/// let region = Region::new([0.0, 0.0], [1000.0, 1000.0])?;
/// assert_eq!(server::candidates(&set, region, 8192)?, 0);
/// // One hundredth of the box.
/// let pond = FieldSpec::radial([500.0, 500.0], [50.0, 56.4], [1.0, 0.0])?;
/// let (visited, kept) = (server::candidates(&set.in_field(pond.clone()), region, 8192)?, set.in_field(pond).count(region)?);
/// assert!(visited > kept && visited < 3 * kept);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub fn candidates(set: &PointSet, area: impl Into<Area>, pieces: usize) -> Result<u128, Error> {
    set.candidates(area.into(), pieces)
}

/// Estimates the nanoseconds that a look at a field takes on a processor of some years ago: the mean over a few places
/// of a region. It counts steps and reads no clock, so every machine returns the same number.
///
/// ```
/// use strew_core::{Region, field::{FieldSpec, Noise}, server};
///
/// let region = Region::new([0.0, 0.0], [100.0, 100.0])?;
/// let noise = |octaves| FieldSpec::noise(Noise { seed: 7, wavelength: 20.0, octaves, range: [0.0, 1.0] });
/// assert!(server::look(&noise(8)?, region) > 5.0 * server::look(&noise(1)?, region));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn look(field: &FieldSpec, within: Region) -> f64 {
    field.nanoseconds(within)
}

/// The columns and rows of the lattice that hold all points of an area, and a few more around it: an id beyond them
/// is no point there.
///
/// # Errors
/// As [`PointSet::within`].
///
/// ```
/// use strew_core::{PointSet, Region, Table, server};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let set = PointSet::new(table).seed(7);
/// let region = Region::new([100.0, 0.0], [110.0, 10.0])?;
/// let [columns, rows] = server::addresses(&set, region)?;
/// for point in set.within(region)? {
///     assert!(columns.contains(&point.id().x) && rows.contains(&point.id().y));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
pub fn addresses(set: &PointSet, area: impl Into<Area>) -> Result<[Range<i64>; 2], Error> {
    set.addresses(area.into())
}

/// Runs [`PointSet::nearest`], or [`PointSet::nearest_within`] if there is a radius, and visits a bounded number of
/// points.
///
/// # Errors
/// As those, [`ErrorKind::TooMany`](crate::ErrorKind::TooMany) where more points would have to be visited, and
/// [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
///
/// ```
/// use strew_core::{PointSet, Table, server::{self, Stop, Visits}};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let (set, visits) = (PointSet::new(table), Visits::new(1000, Stop::default()));
/// assert_eq!(server::nearest(&set, [9.0, 3.0], 5, None, &visits)?, set.nearest([9.0, 3.0], 5)?);
/// # Ok::<(), strew_core::Error>(())
/// ```
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
///
/// ```
/// use strew_core::{PointSet, Table, server::{self, Stop, Visits}};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let (set, visits) = (PointSet::new(table), Visits::new(1000, Stop::default()));
/// assert_eq!(server::around(&set, [9.0, 3.0], 4.0, 100, &visits)?, set.around([9.0, 3.0], 4.0, 100)?);
/// # Ok::<(), strew_core::Error>(())
/// ```
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
///
/// ```
/// use strew_core::{ErrorKind, Region, field::{Pixels, Terrain}, server::{self, Stop}};
///
/// let heights = Pixels::from_floats(3, vec![0.0, 5.0, 10.0])?;
/// let terrain = Terrain::new(Region::new([0.0, 0.0], [30.0, 10.0])?, heights)?;
/// let stop = Stop::new();
/// assert!(server::slope(terrain.clone(), [0.0, 1.0], [1.0, 0.0], &stop).is_ok());
/// stop.raise();
/// let error = server::slope(terrain, [0.0, 1.0], [1.0, 0.0], &stop).unwrap_err();
/// assert_eq!(error.kind(), ErrorKind::Stopped);
/// # Ok::<(), strew_core::Error>(())
/// ```
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
///
/// ```
/// use strew_core::{ErrorKind, Raster, Region, server::{self, Stop}};
///
/// let raster = Raster::new(Region::chunk(2.0, [0, 0])?, 2, vec![0.0, 1.0])?;
/// let stop = Stop::new();
/// assert!(server::tone(raster.clone(), 0.0, 1.0, 2.0, &stop).is_ok());
/// stop.raise();
/// let error = server::tone(raster, 0.0, 1.0, 2.0, &stop).unwrap_err();
/// assert_eq!(error.kind(), ErrorKind::Stopped);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub fn tone(raster: Raster, low: f64, high: f64, gamma: f64, stop: &Stop) -> Result<Raster, Error> {
    raster.tone_unless([low, high, gamma], stop)
}

/// Returns the plan with another flag. Its windows and cursors may have to count, and stop once that flag is raised.
/// Their results are then meaningless.
///
/// ```
/// use strew_core::{Circle, PointSet, Table, server::{self, Stop}};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let stop = Stop::new();
/// let plan = PointSet::new(table).within(Circle::new([0.0, 0.0], 50.0)?)?;
/// let plan = server::stopped_by(plan, stop.clone());
/// // Windows of the plan stop once `stop` is raised.
/// let page = plan.window(1000, Some(100));
/// assert!(!stop.is_raised() && page.count() == 100);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn stopped_by(plan: Plan, stop: Stop) -> Plan {
    plan.with_stop(stop)
}

/// Cuts a plan into windows that begin at the given ascending offsets. Each window ends where the next begins, and the
/// last one at the end of the plan. Where finding a place takes time proportional to the rows, many windows take
/// little longer than one.
///
/// ```
/// use strew_core::{Circle, PointSet, Table, server};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).within(Circle::new([0.0, 0.0], 50.0)?)?;
/// let pages = server::windows(&plan, &[0, 100, 250]);
/// assert_eq!(pages[1].to_vec(), plan.window(100, Some(150)).to_vec());
/// assert_eq!(pages[2].count(), plan.count() - 250);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn windows(plan: &Plan, offsets: &[u128]) -> Vec<Plan> {
    plan.windows(offsets, plan.count())
}

/// The bytes of the points and places that counting has kept in a plan, beside its area.
///
/// ```
/// use strew_core::{PointSet, Region, Table, server::{forgetting, kept}};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).seed(7).within(Region::chunk(20.0, [0, 0])?)?;
/// let lean = forgetting(plan.clone());
/// assert!(kept(&plan) >= 12 * plan.iter().len() && kept(&lean) == 0);
/// assert_eq!(lean.to_vec(), plan.to_vec());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn kept(plan: &Plan) -> usize {
    plan.kept()
}

/// Returns the plan without the points and places that counting has kept. It finds them again, which takes time.
///
/// ```
/// use strew_core::{PointSet, Region, Table, server::forgetting};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).seed(7).within(Region::chunk(20.0, [0, 0])?)?;
/// assert_eq!(forgetting(plan.clone()).count(), plan.count());
/// # Ok::<(), strew_core::Error>(())
/// ```
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
///
/// ```
/// use strew_core::{PointSet, Region, Table, server};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let dense = PointSet::new(table).spacing(1e-6)?.within(Region::chunk(10.0, [0, 0])?)?;
/// let preview = server::preview(&dense, 0.5)?;
/// let mut points = vec![[0.0; 2]; 1000];
/// let filled = preview.blocks_f64().fill(&mut points);
/// assert!((350..450).contains(&filled));
/// # Ok::<(), strew_core::Error>(())
/// ```
pub fn preview(plan: &Plan, spacing: f64) -> Result<Plan, Error> {
    plan.with_spacing(Spacing::new(spacing)?)
}

/// The number of steps by which the points of a set settle, 0 if they stay.
///
/// ```
/// use strew_core::{PointSet, Table, server::steps};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let all = PointSet::new(table);
/// let half = all.clone().keep(0.5)?;
/// assert_eq!((steps(&all), steps(&half)), (0, 2));
/// assert_eq!((steps(&all.settle(3)?), steps(&half.settle(3)?)), (1, 3));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn steps(set: &PointSet) -> u32 {
    set.steps()
}

/// About how long a set's points settle near an outline, in steps of a set without kinds; 0 if they do not. Points of
/// kinds push each other twice and reach farther.
///
/// ```
/// use strew_core::{PointSet, Table, server::settling, table::{Mix, Ranks}};
///
/// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let half = PointSet::new(table.clone()).keep(0.5)?;
/// assert_eq!(settling(&half.clone().settle(0)?), 0.0);
/// assert_eq!(settling(&half), 2.0);
/// let mix = Mix::scattered(table.map(), "1:3".parse()?)?;
/// let ranks = Ranks::new((0..mix.labels().len() as u32).collect())?;
/// let kinds = PointSet::new(table.with_mix(mix, ranks)?).keep(0.5)?;
/// assert_eq!(settling(&kinds), 8.0);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn settling(set: &PointSet) -> f64 {
    set.settling()
}

/// A bound of the share of points that a set has in a box: its share, times that of its field.
///
/// ```
/// use strew_core::{PointSet, Region, Table, server::greatest_share};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let view = Region::new([0.0, 0.0], [20.0, 20.0])?;
/// assert_eq!(greatest_share(&PointSet::new(table).keep(0.5)?, &view), 0.5);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn greatest_share(set: &PointSet, within: &Region) -> f64 {
    set.greatest_share(within)
}

/// About half the length, along the axes and in world units, of the outlines of all shapes of an area
/// inside `within`: width + height for a box. Counting an area takes time in proportion to this and to
/// its height.
///
/// ```
/// use strew_core::{Area, Circle, Region, server::outline};
///
/// let view = Region::new([0.0, 0.0], [30.0, 10.0])?;
/// assert_eq!(outline(&view.into(), view), 40.0);
/// // A circle inside counts as the box around it.
/// let pond = Area::from(Circle::new([5.0, 5.0], 3.0)?);
/// assert!((outline(&pond, view) - 12.0).abs() < 1e-9);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn outline(area: &Area, within: Region) -> f64 {
    area.outline(within)
}

/// About how many comparisons of points with sides of polygons, boxes and circles it takes to count an area inside
/// `within`, at this spacing: points beside an outline are compared with all sides near them. A further cost of areas with
/// many sides. Takes time in proportion to them and to the outline.
///
/// ```
/// use strew_core::{Area, Circle, Region, Spacing, server::comparisons};
///
/// let view = Region::chunk(100.0, [0, 0])?;
/// let pond = Area::from(Circle::new([50.0, 50.0], 9.0)?);
/// let ponds = Area::any_of(vec![pond.clone(); 50]);
/// // Points beside fifty circles are compared with fifty circles, until all points of the view are.
/// let ratio = |spacing| comparisons(&ponds, view, spacing) / comparisons(&pond, view, spacing);
/// assert!(ratio(Spacing::new(0.1)?) > 500.0 && ratio(Spacing::new(9.0)?) >= 50.0);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn comparisons(area: &Area, within: Region, spacing: Spacing) -> f64 {
    /// About the lattice units in a mean spacing.
    const UNITS: f64 = 3.0;
    area.comparisons(within, spacing.get() / UNITS)
}
