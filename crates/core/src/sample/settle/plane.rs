//! The settler of a lattice of the plane.

use super::{lister::Lister, window::Settler};
use crate::sample::lattice::{Lattice, PointId};

impl Settler {
    /// A settler of a lattice whose points settle; `None` of others.
    pub(crate) fn new(lattice: &Lattice) -> Option<Self> {
        let (settle, grade) = (lattice.settle()?, lattice.grade.clone()?);
        Some(Self::of(Lister::new(lattice), grade, settle))
    }

    /// The settled place of an address, or `None` if it has no point.
    pub(crate) fn point(&mut self, lattice: &Lattice, id: PointId) -> Option<[i128; 2]> {
        let place = lattice.place(id)?;
        self.settled(place, |placed| {
            PointId::of(placed.address) == id && lattice.shows(id, placed.share)
        })
    }
}

impl PointId {
    /// The id of an address.
    pub(crate) const fn of([x, y]: [i64; 2]) -> Self {
        Self { x, y }
    }
}
