//! Single points of a set: by id and near a place, with the values they have.

use alloc::vec::Vec;

use super::PointSet;
use crate::{
    error::Error,
    sample::{
        attribute::{Attributes, BoundAttributes},
        lattice::{Placement, PointId, rank},
        member::Member,
        near::{Clearance, limits, search},
    },
};

/// A point of a set near a place, and its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// The point.
    pub member: Member,
    /// The distance from the place, in world units.
    pub distance: f64,
}

impl PointSet {
    /// The most points that [`nearest`](Self::nearest) returns.
    pub const MAX_NEAREST: usize = limits::MAX_NEAREST;
    /// The most points that a search visits: a few hundred milliseconds of work.
    pub const MAX_CANDIDATES: usize = limits::MAX_CANDIDATES;

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

    /// The largest absolute coordinate that a search may reach.
    #[must_use]
    pub fn search_limit(&self) -> f64 {
        limits::limit(&self.lattice)
    }
}
