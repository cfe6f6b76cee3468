//! The point set.

use alloc::vec::Vec;

use super::{
    amount,
    area::{Area, Region},
    attribute::{Attributes, BoundAttributes},
    cursor::Cursor,
    lattice::{Keep, Lattice, Placement, PointId, Spacing, rank},
    member::Member,
    near::{ClearOf, Clearance, Mask, limits, search},
    plan::Plan,
    seed::Seed,
    stop::Stop,
    warp::Warp,
};
use crate::{error::Error, table::Table};

/// An unbounded set of points: a table at a spacing, with a seed and a warp.
///
/// Nothing of it is stored. A point is a pure function of these parameters and its lattice address, so
/// the same set has the same points wherever and in whatever order they are requested. Everything to ask
/// of a set is a method: points [within](Self::within) an area, of a [chunk](Self::chunk), by
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
    /// Whether the warp was chosen, and so stays when the seed changes.
    has_own_warp: bool,
}

/// A point of a set near a place, and its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// The point.
    pub member: Member,
    /// The distance from the place, in world units.
    pub distance: f64,
}

impl PointSet {
    /// The set of a table, with mean spacing 1 and seed 0.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// // A table without displacements: the AA pattern itself. Others come from files.
    /// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table);
    /// assert_eq!(set.placement().spacing.get(), 1.0);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn new(table: Table) -> Self {
        Self {
            lattice: Lattice::new(table, Placement::new(Spacing::ONE, Seed(0))),
            mask: Mask::default(),
            has_own_warp: false,
        }
    }

    /// The blue-noise set of the table built into the crate (feature `tables`): evenly spread points
    /// without visible structure.
    ///
    /// ```
    /// use strew_core::PointSet;
    ///
    /// let set = PointSet::blue();
    /// assert_eq!(set.table().profile(), "blue");
    /// // No two points are nearer than this many mean spacings.
    /// assert!(set.least_distance() > 0.7);
    /// ```
    #[cfg(feature = "tables")]
    #[must_use]
    pub fn blue() -> Self {
        Self::new(crate::table::shipped::blue())
    }

    /// Sets the mean spacing, in world units: density^−½.
    ///
    /// # Errors
    /// [`ErrorKind::Spacing`](crate::ErrorKind::Spacing) outside 10⁻¹⁰⁰ to 10¹⁰⁰.
    pub fn spacing(self, spacing: f64) -> Result<Self, Error> {
        let spacing = Spacing::new(spacing)?;
        Ok(self.replaced(|placement| Placement {
            spacing,
            ..placement
        }))
    }

    /// Sets the density, in points per world unit squared.
    ///
    /// # Errors
    /// [`ErrorKind::Density`](crate::ErrorKind::Density) outside 10⁻²⁰⁰ to 10²⁰⁰.
    pub fn density(self, density: f64) -> Result<Self, Error> {
        let spacing = Spacing::from_density(density)?;
        Ok(self.replaced(|placement| Placement {
            spacing,
            ..placement
        }))
    }

    /// Sets the spacing at which no two points are nearer than `distance` world units, for the warp that
    /// the set has; so choose seed and warp first.
    ///
    /// # Errors
    /// As [`LeastDistance::spacing_for`](crate::LeastDistance::spacing_for).
    ///
    /// ```
    /// use strew_core::{ErrorKind, PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table).seed(7).min_distance(2.0)?;
    /// assert!(set.least_distance() >= 2.0);
    /// assert_eq!(set.min_distance(-1.0).unwrap_err().kind(), ErrorKind::Distance);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn min_distance(self, distance: f64) -> Result<Self, Error> {
        let least = self.table().least_distance();
        let spacing = least.spacing_for(distance, self.placement().warp)?;
        Ok(self.replaced(|placement| Placement {
            spacing,
            ..placement
        }))
    }

    /// Sets the seed. Seed 0 is the plain pattern, whose large windows show its quasi-periodic structure;
    /// every other seed warps the plane, unless [`warp`](Self::warp) says otherwise.
    #[must_use]
    pub fn seed(self, seed: u64) -> Self {
        let own = self.has_own_warp.then(|| self.placement().warp);
        let seed = Seed(seed);
        self.replaced(|placement| Placement {
            seed,
            warp: own.unwrap_or_else(|| Placement::default_warp(seed)),
            ..placement
        })
    }

    /// Sets the strength of the warp, from 0 (off) to 2; 1 is the default of seeds other than 0.
    ///
    /// # Errors
    /// [`ErrorKind::Warp`](crate::ErrorKind::Warp) outside that range.
    pub fn warp(mut self, strength: f64) -> Result<Self, Error> {
        let warp = Warp::new(strength)?;
        self.has_own_warp = true;
        Ok(self.replaced(|placement| placement.with_warp(warp)))
    }

    /// Keeps a share of the points, from 10⁻⁶ to 1. Shares nest: a smaller one keeps a part of what a
    /// larger one keeps.
    ///
    /// # Errors
    /// [`ErrorKind::Keep`](crate::ErrorKind::Keep) outside that range.
    pub fn keep(self, share: f64) -> Result<Self, Error> {
        let keep = Keep::new(share)?;
        Ok(self.replaced(|placement| placement.with_keep(keep)))
    }

    /// Sets spacing, seed, warp and share at once.
    #[must_use]
    pub fn placed(mut self, placement: Placement) -> Self {
        self.has_own_warp = true;
        self.replaced(|_| placement)
    }

    /// Removes the points outside an area.
    ///
    /// ```
    /// use strew_core::{Circle, PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let island = PointSet::new(table).limited_to(Circle::new([0.0, 0.0], 9.0)?);
    /// for p in island.chunk(16.0, [0, 0])? {
    ///     assert!(p.at()[0].hypot(p.at()[1]) < 9.0);
    /// }
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn limited_to(mut self, area: impl Into<Area>) -> Self {
        self.mask = self.mask.and_within(area.into());
        self
    }

    /// Removes the points nearer than `distance` world units to any point of another set.
    ///
    /// The points of the other set near a point decide, wherever points are requested, so neighboring
    /// regions agree.
    ///
    /// # Errors
    /// [`ErrorKind::Clearance`](crate::ErrorKind::Clearance) unless the distance is above 0 and at most 16
    /// mean spacings of the other set.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let trees = PointSet::new(table.clone()).spacing(5.0)?.seed(1);
    /// let flowers = PointSet::new(table).seed(2).clear_of(&trees, 1.5)?;
    /// for flower in flowers.chunk(20.0, [0, 0])? {
    ///     assert!(trees.nearest(flower.at(), 1)?[0].distance >= 1.5);
    /// }
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn clear_of(mut self, other: &Self, distance: f64) -> Result<Self, Error> {
        let other = ClearOf::new(&other.lattice, &other.mask, distance)?;
        self.mask = self.mask.and_clear_of(other);
        Ok(self)
    }

    fn replaced(mut self, change: impl FnOnce(Placement) -> Placement) -> Self {
        let placement = change(self.lattice.placement);
        if placement != self.lattice.placement {
            self.lattice = Lattice::new(self.lattice.table, placement);
        }
        self
    }

    /// The table.
    #[must_use]
    pub const fn table(&self) -> &Table {
        &self.lattice.table
    }

    /// Spacing, seed, warp and share.
    #[must_use]
    pub const fn placement(&self) -> Placement {
        self.lattice.placement
    }

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

    /// The point of an id, or `None` if the set has none there.
    #[must_use]
    pub fn point(&self, id: PointId) -> Option<Member> {
        let point = self.lattice.point(id)?;
        let is_plain = self.mask.area.is_none() && self.mask.clear.is_empty();
        (is_plain || self.mask.guards().permit(point.at()))
            .then(|| Member::new(point, self.placement().seed))
    }

    /// The block of the neighborhood map of a point: the intervals of its two indices, each below
    /// [`Map::intervals`](crate::Map::intervals), or `None` if the lattice has no point there. The points
    /// of a block have the same displacement and, as far as the map reaches, the same neighbors in the
    /// pattern.
    #[must_use]
    pub fn block(&self, id: PointId) -> Option<[usize; 2]> {
        self.lattice.block(id)
    }

    /// The rank of a point: a number in [0, 1), uniform over the pattern. [`keep`](Self::keep) keeps the
    /// points whose rank is below the share. An id without a point has the greatest rank, 1 − 2⁻⁵³.
    #[must_use]
    pub fn rank(&self, id: PointId) -> f64 {
        let pattern = self.lattice.pattern;
        rank(pattern.depth(id.x, id.y), pattern.alpha().set_side())
    }

    /// The `k` nearest points of a place, nearest first; of equally near ones the smaller id first. Takes
    /// microseconds for small `k`.
    ///
    /// Distances are those of the reported coordinates, compared as dx·dx + dy·dy in `f64`.
    ///
    /// # Errors
    /// [`ErrorKind::Neighbors`](crate::ErrorKind::Neighbors) if `k` is above
    /// [`MAX_NEAREST`](Self::MAX_NEAREST), [`ErrorKind::Place`](crate::ErrorKind::Place) if the place is
    /// not finite, [`ErrorKind::TooFar`](crate::ErrorKind::TooFar) if the search leaves the
    /// [limit](Self::search_limit), and [`ErrorKind::TooMany`](crate::ErrorKind::TooMany) if the set has so
    /// few points that more than [`MAX_CANDIDATES`](Self::MAX_CANDIDATES) would be visited.
    pub fn nearest(&self, at: [f64; 2], k: usize) -> Result<Vec<Neighbor>, Error> {
        let found = search::nearest(&self.lattice, &self.mask, at, k)?;
        Ok(self.neighbors(found))
    }

    /// All points within `radius` of a place (dx·dx + dy·dy ≤ radius·radius in `f64`), nearest first; of
    /// equally near ones the smaller id first.
    ///
    /// # Errors
    /// [`ErrorKind::Radius`](crate::ErrorKind::Radius) unless the radius is a finite number from 0 on,
    /// [`ErrorKind::TooMany`](crate::ErrorKind::TooMany) if more than `limit` points lie within it (at most
    /// [`MAX_CANDIDATES`](Self::MAX_CANDIDATES)), and as [`nearest`](Self::nearest).
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table).seed(7);
    /// let near = set.around([1000.5, -3.25], 2.0, 100)?;
    /// assert!(near.iter().all(|neighbor| neighbor.distance <= 2.0));
    /// assert_eq!(set.nearest([1000.5, -3.25], near.len())?, near);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn around(&self, at: [f64; 2], radius: f64, limit: usize) -> Result<Vec<Neighbor>, Error> {
        let limit = limit.min(Self::MAX_CANDIDATES);
        let found = search::within(&self.lattice, &self.mask, at, radius, limit)?;
        Ok(self.neighbors(found))
    }

    fn neighbors(&self, found: Vec<search::Found>) -> Vec<Neighbor> {
        let seed = self.placement().seed;
        let neighbor = |(squared, point)| Neighbor {
            member: Member::new(point, seed),
            distance: libm::sqrt(squared),
        };
        found.into_iter().map(neighbor).collect()
    }

    /// A test whether any point lies nearer than `distance` to a place, for many places.
    ///
    /// # Errors
    /// [`ErrorKind::Radius`](crate::ErrorKind::Radius) or [`ErrorKind::TooMany`](crate::ErrorKind::TooMany)
    /// unless the distance is a finite number from 0 on within which at most
    /// [`Clearance::MAX_CANDIDATES`] points lie on average.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let mut clearance = PointSet::new(table).spacing(3.0)?.clearance(6.0)?;
    /// assert!(clearance.is_any_near([10.0, 10.0], |_| true));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn clearance(&self, distance: f64) -> Result<Clearance, Error> {
        Clearance::new(self.lattice.clone(), &self.mask, distance)
    }

    /// The least distance between any two points, in world units: a guarantee for all of the plane. It is 0
    /// for profiles that guarantee none.
    #[must_use]
    pub fn least_distance(&self) -> f64 {
        let Placement { spacing, warp, .. } = self.placement();
        self.table().least_distance().with_warp(warp) * spacing.get()
    }

    /// The values that the points of this set have for some attributes. They depend on ids and the seed
    /// alone.
    #[must_use]
    pub fn attributes(&self, attributes: &Attributes) -> BoundAttributes {
        BoundAttributes::new(attributes, &self.lattice)
    }

    /// The most points that [`nearest`](Self::nearest) returns.
    pub const MAX_NEAREST: usize = limits::MAX_NEAREST;
    /// The most points that a search visits: a few hundred milliseconds of work.
    pub const MAX_CANDIDATES: usize = limits::MAX_CANDIDATES;

    /// The largest absolute coordinate of a requested area: ±2⁵² lattice units.
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.lattice.limit()
    }

    /// The largest absolute coordinate that a search may reach.
    #[must_use]
    pub fn search_limit(&self) -> f64 {
        limits::limit(&self.lattice)
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

#[cfg(test)]
mod tests {
    use super::*;

    const fn is_shared<T: Clone + Send + Sync>() {}

    const _: () = is_shared::<PointSet>();
    const _: () = is_shared::<Plan>();
    const _: () = is_shared::<Table>();

    #[test]
    fn a_chosen_warp_stays() {
        let table = Table::undisplaced("sqrt(3)".parse().expect("valid"), 3, "pattern");
        let set = PointSet::new(table.expect("small"));
        assert_eq!(set.placement().warp, Warp::OFF);
        assert_eq!(set.clone().seed(3).placement().warp, Warp::ON);
        assert_eq!(set.clone().seed(3).seed(0).placement().warp, Warp::OFF);
        let own = set.warp(0.5).expect("in range");
        assert_eq!(own.seed(3).placement().warp.strength(), 0.5);
    }
}
