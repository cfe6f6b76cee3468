//! The points of an area: plans of a set, and their counts.

use core::ops::Range;

use super::PointSet;
use crate::{
    error::Error,
    sample::{Placement, Sought, exactly, field::candidates, plan::Plan, scope::Scope},
    shape::Area,
    stop::Stop,
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
    ///
    /// ```
    /// use strew_core::{Circle, ErrorKind, PointSet, Region, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table).seed(7);
    /// let lake = Circle::new([100.0, 40.0], 9.0)?;
    /// assert!(set.within(lake)?.iter().all(|point| lake.contains(point.at())));
    /// let far = Region::new([0.0, 0.0], [1e20, 1.0])?;
    /// assert_eq!(set.within(far).unwrap_err().kind(), ErrorKind::TooFar);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn within(&self, area: impl Into<Area>) -> Result<Plan, Error> {
        self.within_until(area.into(), Stop::default())
    }

    /// Exactly `count` points in an area. The search ignores the spacing of the set; the plan's
    /// [placement](Plan::placement) has the spacing that it found.
    ///
    /// Without warp two points may enter a box at the same spacing. Then the last one is left out.
    ///
    /// In a [field](Self::in_field) the spacing is that where the share is 1. Several spacings may place the count;
    /// every machine finds the same one.
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

    /// The largest absolute coordinate of a requested area, in world units: 2⁵² lattice units.
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.lattice.limit()
    }

    /// The columns and rows that hold all points of an area.
    pub(crate) fn addresses(&self, area: Area) -> Result<[Range<i64>; 2], Error> {
        let scope = Scope::new(&self.lattice, &self.mask, area, Stop::default())?;
        Ok([scope.x.all, scope.y.all])
    }

    /// About the number of points that counting an area visits one by one; 0 without a field.
    pub(crate) fn candidates(&self, area: Area, pieces: usize) -> Result<u128, Error> {
        if self.lattice.grade.is_none() {
            return Ok(0);
        }
        let scope = Scope::new(&self.lattice, &self.mask, area, Stop::default())?;
        let Some(grade) = &scope.lattice.grade else {
            return Ok(0);
        };
        if grade.known().is_some() {
            return Ok(0);
        }
        let piece = [scope.x.all.clone(), scope.y.all.clone()];
        Ok(candidates(&scope.lattice, grade, piece, pieces))
    }

    /// Runs [`within`](Self::within), whose counting a flag stops.
    pub(crate) fn within_until(&self, area: Area, stop: Stop) -> Result<Plan, Error> {
        Plan::new(&self.lattice, &self.mask, area, stop, None)
    }

    /// Runs [`exactly`](Self::exactly) without spacings below `least`; a flag stops its counting.
    pub(crate) fn exactly_until(
        &self,
        count: u128,
        area: &Area,
        least: f64,
        stop: &Stop,
    ) -> Result<Plan, Error> {
        let within = self.mask.clone().and_within(area.clone()).area;
        let grade = self.lattice.grade.as_ref();
        let sought = Sought {
            count,
            bounds: within.as_ref().and_then(Area::bounds),
            least,
            grade,
            share: match grade {
                Some(_) => self.lattice.kind_share(),
                None => self.lattice.share(),
            },
        };
        exactly(&sought, |spacing| {
            let placement = Placement {
                spacing,
                ..self.lattice.placement
            };
            let trial = self.lattice.replaced(placement);
            Plan::new(&trial, &self.mask, area.clone(), stop.clone(), None)
        })
    }
}
