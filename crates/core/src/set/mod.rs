//! The point set.
//!
//! A set is a table, a placement and a mask. This file has the set and the methods that change it, beside those in
//! `methods`, which sets in space share, and the plans of areas; `lookups` has single points, and `kinds` the points of
//! kinds.

mod kinds;
mod lookups;
pub use kinds::Kind;

use alloc::sync::Arc;

use crate::{
    attribute::Kinds,
    error::Error,
    field::{Field, candidates},
    lattice::{Keep, Lattice, Placement, Spacing, seed::Seed},
    methods::placing,
    near::Mask,
    plan::{
        Plan,
        amount::{Sought, exactly},
    },
    shape::Area,
    stop::Stop,
    table::Table,
    walk::scope::Scope,
    warp::Warp,
};

/// An unbounded set of points: a table at a spacing, with a seed and a warp.
///
/// No point is stored. A point is a pure function of these parameters and its lattice address, so
/// equal sets have equal points, in whatever place and order a program requests them. Each request is
/// a method: points [within](Self::within) an area, of a [chunk](Self::chunk), by
/// [id](Self::point), [near](Self::nearest) a place; their [count](Self::count) and their [least
/// distance](Self::least_distance).
///
/// A set is made from a table, with mean spacing 1 and seed 0; methods that take `self` change that. Sets
/// are cheap to clone and can be shared between threads.
///
#[cfg_attr(feature = "tables", doc = "```")]
#[cfg_attr(not(feature = "tables"), doc = "```ignore")]
/// use strew_core::PointSet;
/// # fn spawn(_: strew_core::PointId, _: [f64; 2], _: f64, _: f64) {}
///
/// let trees = PointSet::blue().spacing(4.0)?.seed(7);
/// for p in trees.chunk(64.0, [3, -2])? {
///     spawn(p.id(), p.at(), p.angle(), p.scale(0.8..=1.2));
/// }
/// let near = trees.nearest([10.0, 3.0], 5)?;
/// let id = near[0].member.id();
/// let same = trees.point(id);
/// assert_eq!(same, Some(near[0].member));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PointSet {
    lattice: Lattice,
    mask: Mask,
    /// The names of the kinds, if they have names.
    named: Option<Kinds>,
    /// Whether the warp was chosen, and so stays when the seed changes.
    has_own_warp: bool,
}

impl PointSet {
    /// The set of a table, with mean spacing 1 and seed 0.
    #[must_use]
    pub fn new(table: Table) -> Self {
        Self {
            lattice: Lattice::new(table, Placement::new(Spacing::ONE, Seed(0))),
            mask: Mask::default(),
            named: None,
            has_own_warp: false,
        }
    }

    /// The blue-noise set of the table built into the crate (feature `tables`): evenly spread points
    /// without visible structure.
    #[cfg(feature = "tables")]
    #[must_use]
    pub fn blue() -> Self {
        Self::new(crate::table::shipped::blue())
    }

    /// The set in a field: the share of its points varies from place to place. The field replaces an earlier one.
    /// [`keep`](Self::keep) multiplies the shares.
    ///
    /// A point belongs to the set if its rank is below the field's share at its place. Sets of one seed share their
    /// points: in a larger share a point stays, and where it is.
    ///
    /// Counting visits the points one by one, in time proportional to the points at full density where bounds of
    /// the field leave any. Where the field is constant in all of an area, counting costs as much as without a field.
    #[cfg(feature = "fields")]
    #[must_use]
    pub fn in_field(&self, field: impl Field + 'static) -> Self {
        Self {
            lattice: self.lattice.in_field(Arc::new(field)),
            ..self.clone()
        }
    }
}

placing!(
    PointSet, Table, power: "½", 2,
    "strew_core::PointSet::new(strew_core::Table::undisplaced(\"sqrt(3)\".parse()?, 20, \"pattern\")?)",
    "[0, 0]"
);

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
    pub fn exactly(&self, count: u128, area: impl Into<Area>) -> Result<Plan, Error> {
        self.exactly_until(count, area, 0.0, &Stop::default())
    }

    /// The largest absolute coordinate of a requested area, in world units: 2⁵² lattice units.
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.lattice.limit()
    }

    /// Estimates the number of points that counting an area visits one by one in a [field](Self::in_field); making them
    /// visits them again. The area's box is cut into up to `pieces` pieces, in each of which the points at full density
    /// are multiplied by the greatest share. It is 0 in no field.
    ///
    /// # Errors
    /// As [`within`](Self::within).
    pub fn candidates(&self, area: impl Into<Area>, pieces: usize) -> Result<u128, Error> {
        if self.lattice.grade.is_none() {
            return Ok(0);
        }
        let scope = Scope::new(&self.lattice, &self.mask, area.into(), Stop::default())?;
        let Some(grade) = &scope.lattice.grade else {
            return Ok(0);
        };
        if grade.known().is_some() {
            return Ok(0);
        }
        let piece = [scope.x.all.clone(), scope.y.all.clone()];
        Ok(candidates(&scope.lattice, grade, piece, pieces))
    }

    /// The points in an area, whose counting stops once a flag is raised.
    ///
    /// # Errors
    /// As [`within`](Self::within), and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
    pub fn within_until(&self, area: impl Into<Area>, stop: Stop) -> Result<Plan, Error> {
        Plan::new(&self.lattice, &self.mask, area.into(), stop, None)
    }

    /// [`exactly`](Self::exactly) without spacings below `least`, whose counting stops once a flag is raised. Where
    /// counting takes time in proportion to the lattice rows, `least` bounds it.
    ///
    /// # Errors
    /// As [`exactly`](Self::exactly), and [`ErrorKind::TooDense`](crate::ErrorKind::TooDense) or
    /// [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
    pub fn exactly_until(
        &self,
        count: u128,
        area: impl Into<Area>,
        least: f64,
        stop: &Stop,
    ) -> Result<Plan, Error> {
        let area = area.into();
        let grade = self.lattice.grade.as_ref();
        let sought = Sought {
            count,
            bounds: self.mask.narrowed(&area).bounds(),
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
