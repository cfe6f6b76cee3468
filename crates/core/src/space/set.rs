//! The point set.

use super::{
    Cursor, Region, Volume,
    lattice::Lattice,
    mask::{ClearOf, Mask},
    plan::Plan,
    table::Table,
};
use crate::{
    error::{Error, ErrorKind, number},
    sample::{Keep, Placement, Seed, Spacing, Warp, limits},
    stop::Stop,
};

/// An unbounded set of points in space: a table at a spacing, with a seed and a warp.
///
/// No point is stored. A point is a pure function of these parameters and its lattice address, so equal sets have equal
/// points, in whatever place and order a program requests them.
///
/// A set is made from a table, with mean spacing 1 and seed 0; methods that take `self` change that. Sets are cheap to
/// clone and can be shared between threads.
///
#[cfg_attr(feature = "tables", doc = "```")]
#[cfg_attr(not(feature = "tables"), doc = "```ignore")]
/// use strew_core::space::SpaceSet;
/// # fn spawn(_: strew_core::space::PointId, _: [f64; 3]) {}
///
/// let rocks = SpaceSet::blue().spacing(4.0)?.seed(7);
/// for p in rocks.chunk(32.0, [3, -2, 0])? {
///     spawn(p.id, p.at());
/// }
/// let near = rocks.nearest([10.0, 3.0, 5.0], 5)?;
/// assert_eq!(rocks.point(near[0].point.id), Some(near[0].point));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SpaceSet {
    lattice: Lattice,
    mask: Mask,
    /// Whether the warp was chosen, and so stays when the seed changes.
    has_own_warp: bool,
}

impl SpaceSet {
    /// The largest number of points that [`nearest`](Self::nearest) returns.
    pub const MAX_NEAREST: usize = limits::MAX_NEAREST;
    /// The largest number of points that a search visits.
    pub const MAX_CANDIDATES: usize = limits::MAX_CANDIDATES;

    /// The set of a table, with mean spacing 1 and seed 0.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
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

    /// The blue-noise set of the table built into the crate (feature `tables`).
    ///
    /// ```
    /// use strew_core::space::SpaceSet;
    ///
    /// let set = SpaceSet::blue();
    /// assert_eq!(set.table().profile(), "blue");
    /// // No two points are nearer than this many mean spacings.
    /// assert!(set.least_distance() > 0.74);
    /// ```
    #[cfg(feature = "tables")]
    #[must_use]
    pub fn blue() -> Self {
        Self::new(super::shipped::blue())
    }

    /// The set of a table file.
    ///
    /// # Errors
    /// As [`Table::from_bytes`].
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let file = Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?.to_bytes();
    /// assert_eq!(SpaceSet::from_table(&file)?.table().profile(), "pattern");
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn from_table(bytes: &[u8]) -> Result<Self, Error> {
        Table::from_bytes(bytes).map(Self::new)
    }

    /// Sets the mean spacing, in world units: density^−⅓.
    ///
    /// # Errors
    /// [`ErrorKind::Spacing`] outside 10⁻¹⁰⁰ to 10¹⁰⁰.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
    /// let count = set.clone().spacing(2.0)?.chunk(100.0, [0, 0, 0])?.count();
    /// assert!((count as f64 / 125_000.0 - 1.0).abs() < 0.01);
    /// assert!(set.spacing(0.0).is_err());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn spacing(self, spacing: f64) -> Result<Self, Error> {
        let spacing = Spacing::new(spacing)?;
        Ok(self.replaced(|placement| Placement {
            spacing,
            ..placement
        }))
    }

    /// Sets the density, in points per world unit cubed.
    ///
    /// # Errors
    /// [`ErrorKind::Density`] outside 10⁻²⁰⁰ to 10²⁰⁰.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).density(8.0)?;
    /// assert_eq!(set.placement().spacing.get(), 0.5);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn density(self, density: f64) -> Result<Self, Error> {
        let (min, max) = (Spacing::MIN_DENSITY, Spacing::MAX_DENSITY);
        if !(min..=max).contains(&density) {
            let allowed = alloc::format!("a number from {min:e} to {max:e}");
            let value = number(density);
            return Err(Error::new(ErrorKind::Density, "density", value, allowed));
        }
        self.spacing(1.0 / libm::cbrt(density))
    }

    /// Sets the spacing at which no two points are nearer than `distance` world units, for the warp that the set has; so
    /// choose seed and warp first.
    ///
    /// # Errors
    /// As [`LeastDistance::spacing_for`](super::LeastDistance::spacing_for).
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7).min_distance(2.0)?;
    /// assert!(set.least_distance() >= 2.0);
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

    /// Sets the seed: the origin in the pattern, one of the 48 symmetries of the cube, and a warp. Seed 0 is the plain
    /// pattern, whose large windows show its quasi-periodic structure; every other seed warps space, unless
    /// [`warp`](Self::warp) sets another strength.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
    /// let first = |seed| set.clone().seed(seed).chunk(4.0, [0, 0, 0]).map(|plan| plan.to_vec()[0]);
    /// assert_eq!(first(7)?, first(7)?);
    /// assert_ne!(first(7)?, first(8)?);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn seed(self, seed: u64) -> Self {
        let seed = Seed(seed);
        let own = self.has_own_warp.then_some(self.lattice.placement.warp);
        let warp = own.unwrap_or_else(|| Placement::default_warp(seed));
        self.replaced(|placement| Placement {
            seed,
            warp,
            ..placement
        })
    }

    /// Sets the strength of the warp, from 0 (off) to 2; 1 is the default of seeds other than 0.
    ///
    /// # Errors
    /// [`ErrorKind::Warp`] outside that range.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// assert!(set.clone().warp(0.0)?.least_distance() > set.least_distance());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn warp(mut self, strength: f64) -> Result<Self, Error> {
        let warp = Warp::new(strength)?;
        self.has_own_warp = true;
        Ok(self.replaced(|placement| Placement { warp, ..placement }))
    }

    /// Keeps a share of the points, from 10⁻⁶ to 1. Shares nest: a smaller one keeps a part of what a larger one keeps.
    ///
    /// # Errors
    /// [`ErrorKind::Keep`] outside that range.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let all = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// for point in all.clone().keep(0.5)?.chunk(8.0, [0, 0, 0])? {
    ///     assert!(all.rank(point.id) < 0.5);
    /// }
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn keep(self, share: f64) -> Result<Self, Error> {
        let keep = Keep::new(share)?;
        Ok(self.replaced(|placement| Placement { keep, ..placement }))
    }

    pub(super) const fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    pub(super) const fn mask(&self) -> &Mask {
        &self.mask
    }

    fn replaced(mut self, change: impl FnOnce(Placement) -> Placement) -> Self {
        let placement = change(self.lattice.placement);
        if placement != self.lattice.placement {
            self.lattice = Lattice::new(self.lattice.table, placement);
        }
        self
    }

    /// Leaves only the points in a volume. Sets that keep clear of this one keep clear of these.
    ///
    /// ```
    /// use strew_core::space::{Ball, SpaceSet, Table};
    ///
    /// let ball = Ball::new([0.0; 3], 5.0)?;
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).limited_to(ball);
    /// assert!(set.chunk(16.0, [0, 0, 0])?.iter().all(|point| ball.contains(point.at())));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn limited_to(mut self, volume: impl Into<Volume>) -> Self {
        self.mask = self.mask.and_within(volume.into());
        self
    }

    /// Removes the points nearer than `distance` world units to any point of another set.
    ///
    /// The points of the other set near a point decide, wherever points are requested, so neighboring volumes agree.
    ///
    /// # Errors
    /// [`ErrorKind::Clearance`] unless the distance is above 0 and at most 16 mean spacings of the other set.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
    /// let stars = set.clone().spacing(4.0)?.seed(1);
    /// let dust = set.seed(2).clear_of(&stars, 1.5)?;
    /// for grain in dust.chunk(8.0, [0, 0, 0])? {
    ///     assert!(stars.nearest(grain.at(), 1)?[0].distance >= 1.5);
    /// }
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn clear_of(mut self, other: &Self, distance: f64) -> Result<Self, Error> {
        let other = ClearOf::new(&other.lattice, &other.mask, distance)?;
        self.mask = self.mask.and_clear_of(other);
        Ok(self)
    }

    /// The points in a volume.
    ///
    /// A box without warp is counted in a fraction of a millisecond, whatever it holds; all else in time proportional to
    /// its surface.
    ///
    /// # Errors
    /// [`ErrorKind::TooFar`] if the volume reaches beyond [`LATTICE_LIMIT`](super::LATTICE_LIMIT) at this spacing,
    /// [`ErrorKind::Unbounded`] if it is not bounded.
    ///
    /// ```
    /// use strew_core::space::{Ball, SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// let ball = Ball::new([100.0, 40.0, 0.0], 9.0)?;
    /// assert!(set.within(ball)?.iter().all(|point| ball.contains(point.at())));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn within(&self, volume: impl Into<Volume>) -> Result<Plan, Error> {
        self.within_until(volume, Stop::default())
    }

    /// The points in a volume, whose counting stops once a flag is raised.
    ///
    /// # Errors
    /// As [`within`](Self::within), and [`ErrorKind::Stopped`].
    ///
    /// ```
    /// use strew_core::{ErrorKind, server::Stop, space::{Region, SpaceSet, Table}};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
    /// let stop = Stop::new();
    /// stop.raise();
    /// let error = set.within_until(Region::chunk(9.0, [0, 0, 0])?, stop).unwrap_err();
    /// assert_eq!(error.kind(), ErrorKind::Stopped);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn within_until(&self, volume: impl Into<Volume>, stop: Stop) -> Result<Plan, Error> {
        Plan::new((&self.lattice, &self.mask), &volume.into(), stop, None)
    }

    /// The points of the chunk at the place `at` of a grid of cubes with a side of `size` world units. Chunks share no
    /// point and lose none.
    ///
    /// # Errors
    /// As [`Region::chunk`] and [`within`](Self::within).
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// let corners = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2]);
    /// let parts = corners.map(|at| set.chunk(8.0, at).map(|plan| plan.count()));
    /// assert_eq!(parts.sum::<Result<u128, _>>()?, set.chunk(16.0, [0, 0, 0])?.count());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn chunk(&self, size: f64, at: [i64; 3]) -> Result<Plan, Error> {
        self.within(Region::chunk(size, at)?)
    }

    /// The points in a volume from a cursor on, found without counting. The cursor belongs to the same volume of the
    /// same set.
    ///
    /// # Errors
    /// As [`within`](Self::within).
    ///
    /// ```
    /// use strew_core::space::{Region, SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// let region = Region::chunk(9.0, [0, 0, 0])?;
    /// let mut page = set.within(region)?.window(0, Some(100));
    /// let mut points = page.to_vec();
    /// while let Some(cursor) = page.next_cursor() {
    ///     page = set.resume(region, cursor)?.window(0, Some(100));
    ///     points.extend(page.to_vec());
    /// }
    /// assert_eq!(points, set.within(region)?.to_vec());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn resume(&self, volume: impl Into<Volume>, cursor: Cursor) -> Result<Plan, Error> {
        let plan = Plan::new(
            (&self.lattice, &self.mask),
            &volume.into(),
            Stop::default(),
            Some(cursor.total),
        )?;
        Ok(plan.from_cursor(cursor))
    }

    /// The number of points in a volume; see [`within`](Self::within) for what it costs.
    ///
    /// # Errors
    /// As [`within`](Self::within).
    ///
    /// ```
    /// use strew_core::space::{Region, SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
    /// let count = set.count(Region::new([-5e8; 3], [5e8; 3])?)?;
    /// assert!((count as f64 / 1e27 - 1.0).abs() < 1e-6);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn count(&self, volume: impl Into<Volume>) -> Result<u128, Error> {
        self.within(volume).map(|plan| plan.count())
    }

    /// The distance that no two points of the set are nearer than, in world units; with warp it is a bound.
    #[must_use]
    pub fn least_distance(&self) -> f64 {
        let Placement { spacing, warp, .. } = self.lattice.placement;
        self.table().least_distance().with_warp(warp) * spacing.get()
    }

    /// The table.
    #[must_use]
    pub fn table(&self) -> &Table {
        &self.lattice.table
    }

    /// Spacing, seed, warp and share.
    #[must_use]
    pub fn placement(&self) -> Placement {
        self.lattice.placement
    }
}
