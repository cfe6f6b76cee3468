//! Single points of a set: by id and near a place, with the values they have.

use alloc::{sync::Arc, vec::Vec};
use core::ops::ControlFlow;

use super::PointSet;
use crate::{
    LeastDistance,
    attribute::{Attributes, BoundAttributes},
    error::Error,
    lattice::{Placement, Point, PointId, seed::Seed},
    methods::requested,
    near::{
        Clearance, Neighbor, Other, Visits,
        limits::{self, Density},
        scan::{Scratch, scan},
        search::{self, Searched},
    },
    pattern::Arrangement,
    plan::{Plan, member::Member},
    settle::{Settler, weight},
    shape::{Area, Region},
    stop::Stop,
    window::Cursor,
};

requested!(
    #[cfg(feature = "clearance")]
    PointSet,
    Area,
    "Region",
    Cursor,
    2,
    "strew_core::PointSet::new(strew_core::Table::undisplaced(\"sqrt(3)\".parse()?, 20, \"pattern\")?)",
    "[0, 0]",
    "[10.0, 3.0]"
);

impl PointSet {
    /// The point of an id, or `None` if the set has none there.
    #[must_use]
    pub fn point(&self, id: PointId) -> Option<Member> {
        let point = match Settler::new(&self.lattice) {
            Some(mut settler) => {
                let place = settler.point(&self.lattice, id)?;
                let [x, y] = place.map(|k| self.lattice.world(k));
                Point { id, x, y }
            }
            None => self.lattice.point(id)?,
        };
        (self.mask.is_none() || self.mask.guard(None).permits(point.at()))
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

    /// The share that decided to keep a point: the share of the [field](Self::in_field) at the point's place at full
    /// density, times the share of the set. `None` if the set is in no field, or has no such point.
    ///
    /// ```
    /// use strew_core::{PointSet, Region, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table).seed(7).in_field(|[x, _]: [f64; 2]| x / 40.0);
    /// for point in set.within(Region::new([10.0, 0.0], [40.0, 9.0])?)? {
    ///     // Where points are sparse, they can be drawn larger.
    ///     let size = set.share(point.id()).map(|share| share.sqrt().recip());
    ///     assert!(size.is_some_and(|size| (1.0..3.0).contains(&size)));
    /// }
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn share(&self, id: PointId) -> Option<f64> {
        self.lattice.share_of(id)
    }

    /// A test whether any point lies nearer than `distance` to a place, for many places.
    ///
    /// # Errors
    /// [`ErrorKind::Radius`](crate::ErrorKind::Radius) or [`ErrorKind::TooMany`](crate::ErrorKind::TooMany)
    /// unless the distance is a finite number from 0 on within which at most
    /// [`Clearance::MAX_CANDIDATES`] points lie on average.
    pub fn clearance(&self, distance: f64) -> Result<Clearance, Error> {
        Clearance::new(self.lattice.clone(), &self.mask, distance)
    }

    /// The least distance between any two points, in world units: a guarantee for reported `f64`
    /// coordinates out to [`LeastDistance::RANGE`](crate::LeastDistance::RANGE) times this distance from the
    /// origin, whatever the region. It is 0 for profiles that guarantee none.
    ///
    /// [`least_distance_within`](Self::least_distance_within) returns the guarantee farther out.
    #[must_use]
    pub fn least_distance(&self) -> f64 {
        self.least_distance_within(0.0)
    }

    /// The least distance between any two points whose `f64` coordinates are within ±`reach`, in world
    /// units; see [`LeastDistance::reported`](crate::LeastDistance::reported).
    #[must_use]
    pub fn least_distance_within(&self, reach: f64) -> f64 {
        if self.lattice.is_in_field() && self.lattice.settle().is_some() {
            return 0.0;
        }
        let Placement { spacing, warp, .. } = self.placement();
        self.table_distance().reported(spacing, warp, reach)
    }

    /// A bound of the share of points that the set has in a box: its share, times that of its field.
    #[must_use]
    pub fn greatest_share(&self, within: &Region) -> f64 {
        let all = self.placement().keep.get();
        match &self.lattice.grade {
            Some(grade) => grade.bounds(within)[1].min(all),
            None => all,
        }
    }

    /// The number of steps by which points settle, 0 if they stay.
    #[must_use]
    pub fn steps(&self) -> u32 {
        let placement = self.placement();
        match self.lattice.is_in_field() {
            true => placement.settle.steps(),
            false => placement.settle.steps_at(placement.keep),
        }
    }

    /// About how long points settle near an outline, in steps of a set without kinds; 0 if they do not. Points of kinds
    /// push each other twice and reach farther.
    #[must_use]
    pub fn settling(&self) -> f64 {
        f64::from(self.steps()) * weight(&self.lattice)
    }

    /// The least distance of the table's points that are of the set's kind, if it has one.
    pub(super) fn table_distance(&self) -> LeastDistance {
        let of_kind = |kind| self.table().least_distance_of(kind, kind);
        // Points of a kind keep the distance of all where they settle.
        let kind = self
            .lattice
            .kind()
            .filter(|_| self.lattice.settle().is_none());
        let of_kind = kind.and_then(of_kind);
        of_kind.unwrap_or_else(|| self.table().least_distance())
    }

    /// The arrangement of `offsets`, in lattice units, in the pattern whose points this set displaces. The arrangement
    /// has its frequency; [`occurs_at`](Arrangement::occurs_at) answers for a point of the set, by its
    /// id, whether it occurs there.
    ///
    /// # Errors
    /// As [`Arrangement::new`].
    ///
    /// ```
    /// use strew_core::{PointId, PointSet, Region, Table};
    ///
    /// # let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table).seed(7);
    /// let pair = set.arrangement(&[(1, 2)])?;
    /// let points = set.within(Region::new([0.0, 0.0], [50.0, 50.0])?)?;
    /// for point in points.iter().filter(|point| pair.occurs_at(point.id().x, point.id().y)) {
    ///     let other = set.point(PointId { x: point.id().x + 1, y: point.id().y + 2 });
    ///     assert!(other.is_some());
    /// }
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn arrangement(&self, offsets: &[(i64, i64)]) -> Result<Arrangement, Error> {
        Arrangement::new(self.lattice.pattern, offsets)
    }

    /// The values that the points of this set have for some attributes. They depend on ids and the seed
    /// alone, ranks and [kinds](crate::Kinds) also on the table.
    ///
    /// # Errors
    /// [`ErrorKind::Kinds`](crate::ErrorKind::Kinds) for kinds of other shares than those of the table's
    /// [mix](crate::Table::mix).
    pub fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
        self.lattice.attributes(attributes)
    }
}

impl Searched<2> for PointSet {
    type Id = PointId;

    fn seed(&self) -> Seed {
        self.placement().seed
    }

    fn density(&self) -> Density<2> {
        Density::of(&self.lattice)
    }

    fn scan(
        &self,
        at: [f64; 2],
        radius: f64,
        farthest: f64,
        visits: &Visits,
        mut found: impl FnMut(f64, Point),
    ) -> ControlFlow<()> {
        let around = Region::between(at.map(|v| v - radius), at.map(|v| v + radius));
        let guard = self.mask.guard(Some(&around));
        let mut scratch = Scratch::default();
        let visits = Some(visits);
        scan(
            &self.lattice,
            &mut scratch,
            at,
            radius,
            visits,
            |d, point| {
                if d <= farthest && guard.permits(point.at()) {
                    found(d, point);
                }
                ControlFlow::Continue(())
            },
        )
    }
}
