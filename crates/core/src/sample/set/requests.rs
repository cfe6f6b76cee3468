//! The points of an area: plans of a set, and their counts.

use super::PointSet;
use crate::{
    error::Error,
    sample::{
        amount,
        area::{Area, Region},
        cursor::Cursor,
        plan::Plan,
        stop::Stop,
    },
};

impl PointSet {
    /// The points in an area.
    ///
    /// A box without warp is counted in some ten microseconds, whatever it holds; a warped box in time
    /// proportional to its circumference; other areas in time proportional to their outline and height;
    /// a set that keeps [clear](Self::clear_of) of others in time proportional to its points.
    ///
    /// # Errors
    /// [`ErrorKind::TooFar`](crate::ErrorKind::TooFar) if the area reaches beyond ±2⁵² lattice units at
    /// this spacing, [`ErrorKind::Unbounded`](crate::ErrorKind::Unbounded) if it is not bounded.
    pub fn within(&self, area: impl Into<Area>) -> Result<Plan, Error> {
        self.within_until(area.into(), Stop::default())
    }

    /// The points of the chunk in column `at[0]` and row `at[1]` of a grid of squares with a side of `size`
    /// world units. Chunks share no point and lose none.
    ///
    /// # Errors
    /// As [`Region::chunk`] and [`within`](Self::within).
    pub fn chunk(&self, size: f64, at: [i64; 2]) -> Result<Plan, Error> {
        self.within(Region::chunk(size, at)?)
    }

    /// Exactly `count` points in an area, at the spacing that takes: the spacing of the set is ignored, and
    /// that of the plan's [placement](Plan::placement) is what was found.
    ///
    /// Without warp two points may enter a box at the same spacing. Then the last one is left out.
    ///
    /// # Errors
    /// [`ErrorKind::Count`](crate::ErrorKind::Count) if the count is 0 or no spacing places it, and as
    /// [`within`](Self::within).
    ///
    /// ```
    /// use strew_core::{Circle, PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let plan = PointSet::new(table).exactly(1000, Circle::new([5.0, 5.0], 1.0)?)?;
    /// assert_eq!(plan.to_vec().len(), 1000);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn exactly(&self, count: u128, area: impl Into<Area>) -> Result<Plan, Error> {
        self.exactly_until(count, &area.into(), 0.0, &Stop::default())
    }

    /// The points in an area from a cursor on, found without counting. The cursor belongs to the same area
    /// of the same set.
    ///
    /// # Errors
    /// As [`within`](Self::within).
    pub fn resume(&self, area: impl Into<Area>, cursor: Cursor) -> Result<Plan, Error> {
        let (area, stop) = (area.into(), Stop::default());
        let plan = Plan::new(&self.lattice, &self.mask, area, stop, Some(cursor.total))?;
        Ok(plan.from_cursor(cursor))
    }

    /// The number of points in an area; see [`within`](Self::within) for what it costs.
    ///
    /// # Errors
    /// As [`within`](Self::within).
    pub fn count(&self, area: impl Into<Area>) -> Result<u128, Error> {
        self.within(area).map(|plan| plan.count())
    }

    /// The largest absolute coordinate of a requested area: ±2⁵² lattice units.
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.lattice.limit()
    }

    /// [`within`](Self::within), whose counting a flag stops.
    pub(crate) fn within_until(&self, area: Area, stop: Stop) -> Result<Plan, Error> {
        Plan::new(&self.lattice, &self.mask, area, stop, None)
    }

    /// [`exactly`](Self::exactly) without spacings below `least`, whose counting a flag stops.
    pub(crate) fn exactly_until(
        &self,
        count: u128,
        area: &Area,
        least: f64,
        stop: &Stop,
    ) -> Result<Plan, Error> {
        amount::exactly(&self.lattice, &self.mask, area, count, least, stop)
    }
}
