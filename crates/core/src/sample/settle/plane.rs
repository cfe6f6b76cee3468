//! The settler of a lattice of the plane.

use super::{Placed, Settled, lister::Lister, window::Settler};
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
            placed.id() == id && lattice.shows(id, placed.share)
        })
    }
}

impl Placed {
    pub(crate) const fn id(&self) -> PointId {
        let [x, y] = self.address;
        PointId { x, y }
    }
}

impl Settled {
    pub(crate) const fn id(&self) -> PointId {
        let [x, y] = self.address;
        PointId { x, y }
    }
}
