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
        sieve::point(&self.lattice, &self.mask, id)
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
        self.lattice.block(id)
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
        nearest::nearest(&self.lattice, &self.mask, at, k, radius, visits)
    }
}
