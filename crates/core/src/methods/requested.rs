//! The methods of sets that find points, the same in the plane and in space.

/// The requests of a set, and what limits it, which has `within`, `nearest_visiting`, and the fields `lattice` and `mask`. In the examples,
/// `$part` is of what keeps clear; `$make` makes a set, `$origin` is the place of a chunk and `$at` one of the world.
macro_rules! requested {
    ($(#[$part:meta])? $Set:ty, $Area:ty, $Region:literal, $Cursor:ty, $dimensions:literal, $make:literal, $origin:literal, $at:literal) => {
        impl $Set {
            /// The largest number of points that [`nearest`](Self::nearest) returns.
            pub const MAX_NEAREST: usize = limits::MAX_NEAREST;
            /// The largest number of points that a search visits: a few hundred milliseconds of work.
            pub const MAX_CANDIDATES: usize = limits::MAX_CANDIDATES;

            /// The points of the chunk at the place `at` of a grid of squares, or cubes, with a side of `size` world
            /// units. Chunks share no point and lose none.
            ///
            /// # Errors
            /// As [`Region::chunk`] and [`within`](Self::within).
            ///
            /// ```
            #[doc = concat!("# let set = ", $make, ".seed(7);")]
            #[doc = concat!("let (mut parts, whole) = (0, set.chunk(16.0, ", $origin, ")?);")]
            #[doc = concat!("for i in 0..1 << ", stringify!($dimensions), " {")]
            #[doc = concat!("    let mut at = ", $origin, ";")]
            ///     for axis in 0..at.len() {
            ///         at[axis] = i >> axis & 1;
            ///     }
            ///     parts += set.chunk(8.0, at)?.count();
            /// }
            /// assert_eq!(parts, whole.count());
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            pub fn chunk(&self, size: f64, at: [i64; $dimensions]) -> Result<Plan, Error> {
                self.within(Region::chunk(size, at)?)
            }

            /// The requested points from a cursor on, found without counting. The cursor belongs to the same request of
            /// the same set.
            ///
            /// # Errors
            /// As [`within`](Self::within).
            pub fn resume(&self, area: impl Into<$Area>, cursor: $Cursor) -> Result<Plan, Error> {
                self.resume_until(area, cursor, Stop::default())
            }

            /// [`resume`](Self::resume) of a plan that a flag stops.
            ///
            /// # Errors
            /// As [`resume`](Self::resume), and [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
            pub fn resume_until(
                &self,
                area: impl Into<$Area>,
                cursor: $Cursor,
                stop: Stop,
            ) -> Result<Plan, Error> {
                let area = area.into();
                let plan = Plan::new(&self.lattice, &self.mask, area, stop, Some(cursor.total))?;
                Ok(plan.from_cursor(cursor))
            }

            /// The number of requested points; see [`within`](Self::within) for what it costs.
            ///
            /// # Errors
            /// As [`within`](Self::within).
            pub fn count(&self, area: impl Into<$Area>) -> Result<u128, Error> {
                self.within(area).map(|plan| plan.count())
            }

            /// Leaves only the points in an area, or a volume. Sets that keep clear of this one keep clear of these.
            ///
            /// ```
            /// use strew_core::{Region, space};
            ///
            #[doc = concat!("# let set = ", $make, ";")]
            #[doc = concat!("let region = ", $Region, "::chunk(5.0, ", $origin, ")?;")]
            #[doc = concat!("let island = set.limited_to(region).chunk(16.0, ", $origin, ")?;")]
            /// assert!(island.to_vec().iter().all(|point| region.contains(point.at())));
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            #[must_use]
            pub fn limited_to(mut self, area: impl Into<$Area>) -> Self {
                self.mask = self.mask.and_within(area.into());
                self
            }

            /// Removes the points nearer than `distance` world units to any point of another set.
            ///
            /// The points of the other set near a point decide, wherever points are requested, so neighboring regions
            /// agree.
            ///
            /// # Errors
            /// [`ErrorKind::Clearance`](crate::ErrorKind::Clearance) unless the distance is above 0 and at most 16 mean
            /// spacings of the other set.
            ///
            /// ```
            #[doc = concat!("# let set = ", $make, ";")]
            /// let trees = set.clone().spacing(5.0)?.seed(1);
            /// let flowers = set.seed(2).clear_of(&trees, 1.5)?;
            #[doc = concat!("for flower in flowers.chunk(10.0, ", $origin, ")?.to_vec() {")]
            ///     assert!(trees.nearest(flower.at(), 1)?[0].distance >= 1.5);
            /// }
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            $(#[$part])?
            pub fn clear_of(mut self, other: &Self, distance: f64) -> Result<Self, Error> {
                let other = Other::kept(&other.lattice, &other.mask, distance)?;
                self.mask = self.mask.and_clear_of(other);
                Ok(self)
            }

            /// Removes the points of some ids, beside those that are removed already. All others stay where they are. Ids
            /// without a point do not matter.
            ///
            /// ```
            #[doc = concat!("# let set = ", $make, ".seed(7);")]
            #[doc = concat!("let all = set.chunk(16.0, ", $origin, ")?.to_vec();")]
            /// let left = set.clone().without([all[0].id]);
            #[doc = concat!("assert_eq!(left.chunk(16.0, ", $origin, ")?.to_vec(), all[1..]);")]
            /// assert!(left.point(all[0].id).is_none());
            /// assert_ne!(left.nearest(all[0].at(), 1)?, set.nearest(all[0].at(), 1)?);
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            #[must_use]
            pub fn without(mut self, ids: impl Into<Arc<[PointId]>>) -> Self {
                self.lattice.without.push(ids.into());
                self
            }

            /// The rank of a point: a number in [0, 1), uniform over the pattern. [`keep`](Self::keep) keeps the points
            /// whose rank is below the share. An id without a point has the greatest rank, 1 − 2⁻⁵³.
            ///
            /// ```
            #[doc = concat!("# let all = ", $make, ".seed(7);")]
            /// let third = all.clone().keep(1.0 / 3.0)?;
            #[doc = concat!("for point in all.chunk(16.0, ", $origin, ")?.to_vec() {")]
            ///     assert_eq!(third.point(point.id).is_some(), all.rank(point.id) < 1.0 / 3.0);
            /// }
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            #[must_use]
            pub fn rank(&self, id: PointId) -> f64 {
                self.lattice.rank(id)
            }

            /// The `k` nearest points of a place, nearest first; of equally near ones the smaller id first. Takes
            /// microseconds for small `k`.
            ///
            /// Distances are those of the reported coordinates, compared as dx·dx + dy·dy (+ dz·dz) in `f64`.
            ///
            /// # Errors
            /// [`ErrorKind::Neighbors`](crate::ErrorKind::Neighbors) unless `k` is from 1 to
            /// [`MAX_NEAREST`](Self::MAX_NEAREST), [`ErrorKind::Place`](crate::ErrorKind::Place) if the place is not
            /// finite, [`ErrorKind::TooFar`](crate::ErrorKind::TooFar) if the search leaves the lattice's limit, and
            /// [`ErrorKind::TooMany`](crate::ErrorKind::TooMany) if the points are so sparse that the search would visit
            /// more than [`MAX_CANDIDATES`](Self::MAX_CANDIDATES).
            ///
            /// ```
            #[doc = concat!("# let wells = ", $make, ".seed(3);")]
            #[doc = concat!("let near = wells.nearest(", $at, ", 3)?;")]
            /// assert!(near.len() == 3 && near.is_sorted_by_key(|well| well.distance));
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            pub fn nearest(
                &self,
                at: [f64; $dimensions],
                k: usize,
            ) -> Result<Vec<Neighbor>, Error> {
                self.nearest_visiting(at, k, None, &Visits::any())
            }

            /// The `k` nearest points of a place among those within `radius`, its end included, nearest first; fewer where
            /// fewer lie there. Nothing beyond the radius is searched.
            ///
            /// # Errors
            /// As [`nearest`](Self::nearest), and [`ErrorKind::Radius`](crate::ErrorKind::Radius) unless the radius is a
            /// finite number from 0 on.
            pub fn nearest_within(
                &self,
                at: [f64; $dimensions],
                k: usize,
                radius: f64,
            ) -> Result<Vec<Neighbor>, Error> {
                self.nearest_visiting(at, k, Some(radius), &Visits::any())
            }

            /// All points within `radius` of a place, nearest first; of equally near ones the smaller id first. A point lies
            /// within if its reported distance is at most the radius.
            ///
            /// # Errors
            /// [`ErrorKind::Radius`](crate::ErrorKind::Radius) unless the radius is a finite number from 0 on,
            /// [`ErrorKind::TooMany`](crate::ErrorKind::TooMany) if more than `limit` points lie within it (at most
            /// [`MAX_CANDIDATES`](Self::MAX_CANDIDATES)), and as [`nearest`](Self::nearest).
            ///
            /// ```
            #[doc = concat!("# let wells = ", $make, ".seed(3);")]
            #[doc = concat!("let near = wells.around(", $at, ", 2.0, 100)?;")]
            #[doc = concat!("assert_eq!(near, wells.nearest_within(", $at, ", 100, 2.0)?);")]
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            pub fn around(
                &self,
                at: [f64; $dimensions],
                radius: f64,
                limit: usize,
            ) -> Result<Vec<Neighbor>, Error> {
                self.around_visiting(at, radius, limit, &Visits::any())
            }

            /// [`nearest`](Self::nearest), or [`nearest_within`](Self::nearest_within) if there is a radius, which visits a
            /// bounded number of points.
            ///
            /// # Errors
            /// As those, [`ErrorKind::TooMany`](crate::ErrorKind::TooMany) where more points would have to be visited, and
            /// [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
            pub fn nearest_visiting(
                &self,
                at: [f64; $dimensions],
                k: usize,
                radius: Option<f64>,
                visits: &Visits,
            ) -> Result<Vec<Neighbor>, Error> {
                search::nearest(self, at, k, radius, visits)
            }

            /// [`around`](Self::around), which visits a bounded number of points.
            ///
            /// # Errors
            /// As [`nearest_visiting`](Self::nearest_visiting).
            pub fn around_visiting(
                &self,
                at: [f64; $dimensions],
                radius: f64,
                limit: usize,
                visits: &Visits,
            ) -> Result<Vec<Neighbor>, Error> {
                search::within(self, at, radius, limit.min(Self::MAX_CANDIDATES), visits)
            }

            /// The largest absolute coordinate that a search may reach, in world units.
            #[must_use]
            pub fn search_limit(&self) -> f64 {
                self.density().limit
            }
        }
    };
}

pub(crate) use requested;
