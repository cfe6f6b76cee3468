//! Single points of a set: by id, and near a place.

use alloc::vec::Vec;

use super::{
    nearest::{self, Neighbor},
    point::{Point, PointId},
    set::SpaceSet,
    sieve,
};
use crate::{error::Error, sample::Visits};

impl SpaceSet {
    /// The point of an id, or `None` if the set has none there.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// let point = set.nearest([10.0, 3.0, 5.0], 1)?[0].point;
    /// assert_eq!(set.point(point.id.to_string().parse()?), Some(point));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn point(&self, id: PointId) -> Option<Point> {
        sieve::point(self.lattice(), self.mask(), id)
    }

    /// The intervals of the three indices of a point, or `None` if the lattice has no point there.
    ///
    /// ```
    /// use strew_core::space::{PointId, SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
    /// assert_eq!(set.block(PointId { x: 0, y: 0, z: 0 }), Some([0; 3]));
    /// assert_eq!(set.block(PointId { x: 1, y: 0, z: 0 }), None);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn block(&self, id: PointId) -> Option<[usize; 3]> {
        self.lattice().block(id)
    }

    /// The rank of a point: a number in [0, 1), uniform over the pattern. [`keep`](Self::keep) keeps the points whose rank
    /// is below the share. An id without a point has the greatest rank, 1 − 2⁻⁵³.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// let low = set.chunk(16.0, [0, 0, 0])?.iter().filter(|point| set.rank(point.id) < 0.25).count();
    /// assert!((900..1150).contains(&low));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn rank(&self, id: PointId) -> f64 {
        self.lattice().rank(id)
    }

    /// The `k` nearest points of a place, nearest first; of equally near ones the smaller id first. Distances are those
    /// of the reported coordinates, compared as dx·dx + dy·dy + dz·dz in `f64`.
    ///
    /// # Errors
    /// [`Place`](crate::ErrorKind::Place) if the place is not finite, [`Neighbors`](crate::ErrorKind::Neighbors) unless
    /// `k` is from 1 to [`MAX_NEAREST`](Self::MAX_NEAREST), [`TooFar`](crate::ErrorKind::TooFar) beyond the lattice's limit, and
    /// [`TooMany`](crate::ErrorKind::TooMany) if too many points would have to be visited.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// let near = set.nearest([10.0, 3.0, 5.0], 5)?;
    /// assert!(near.is_sorted_by(|a, b| a.distance <= b.distance));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn nearest(&self, at: [f64; 3], k: usize) -> Result<Vec<Neighbor>, Error> {
        self.nearest_visiting(at, k, None, &Visits::any())
    }

    /// The nearest points of a place whose distances are at most a radius, `k` of them at most; see
    /// [`nearest`](Self::nearest).
    ///
    /// # Errors
    /// As [`nearest`](Self::nearest), and [`Radius`](crate::ErrorKind::Radius) unless the radius is finite and not
    /// negative.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
    /// let near = set.nearest_within([10.0, 3.0, 5.0], 100, 2.0)?;
    /// assert!(near.iter().all(|neighbor| neighbor.distance <= 2.0));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn nearest_within(
        &self,
        at: [f64; 3],
        k: usize,
        radius: f64,
    ) -> Result<Vec<Neighbor>, Error> {
        self.nearest_visiting(at, k, Some(radius), &Visits::any())
    }

    /// Runs [`nearest`](Self::nearest), or [`nearest_within`](Self::nearest_within) if there is a radius, until a flag is
    /// raised, and counts the points that are visited.
    ///
    /// # Errors
    /// As these, and [`Stopped`](crate::ErrorKind::Stopped).
    ///
    /// ```
    /// use strew_core::{server::{Stop, Visits}, space::{SpaceSet, Table}};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
    /// let visits = Visits::new(usize::MAX, Stop::new());
    /// assert_eq!(set.nearest_visiting([1.0; 3], 5, None, &visits)?.len(), 5);
    /// assert!(visits.made() >= 5);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn nearest_visiting(
        &self,
        at: [f64; 3],
        k: usize,
        radius: Option<f64>,
        visits: &Visits,
    ) -> Result<Vec<Neighbor>, Error> {
        nearest::nearest(self.lattice(), self.mask(), at, k, radius, visits)
    }
}
