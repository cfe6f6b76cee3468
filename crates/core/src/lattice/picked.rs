//! The points of a lattice by kinds whose shares vary: which kind each is of, and which are left if one is wanted.

use super::{Lattice, PointId, VaryingKinds, kinds::Varied};
use crate::table::{Mix, Shares};

impl Lattice {
    /// This lattice with kinds whose shares vary.
    pub(crate) fn with_varied(mut self, kinds: VaryingKinds) -> Self {
        let symmetry = self.placement.seed.symmetry();
        self.varied = Some(Varied::new(kinds, symmetry, None));
        self.kinds = None;
        self
    }

    /// The points that are of a kind, where shares vary.
    pub(super) fn picking(mut self, kind: u8) -> Self {
        let only = Some(kind);
        self.varied = self.varied.map(|varied| Varied { only, ..varied });
        self
    }

    /// The parts of the kinds, if there are kinds.
    pub(crate) fn kind_parts(&self) -> Option<&Shares> {
        match &self.varied {
            Some(varied) => Some(varied.kinds.shares()),
            None => self.table.mix().map(Mix::shares),
        }
    }

    /// Whether the shares of kinds vary.
    pub(crate) const fn is_varied(&self) -> bool {
        self.varied.is_some()
    }

    /// Whether points are left out by their kind one by one.
    pub(crate) fn picks(&self) -> bool {
        self.varied.as_ref().is_some_and(|v| v.only.is_some())
    }

    /// Whether a point is of the kind that is wanted, where points are left out one by one.
    #[inline]
    pub(crate) fn has_kind(&self, id: PointId) -> bool {
        match self.varied.as_ref().and_then(|varied| varied.only) {
            None => true,
            only => self.kind_of(id) == only,
        }
    }

    /// The kind of a point of the pattern, kept or not.
    pub(super) fn varied_kind_of(&self, varied: &Varied, id: PointId) -> Option<u8> {
        let (index_x, index_y) = self.pattern.index(id.x, id.y);
        let x = self.map().interval_of(index_x)?;
        let y = self.map().interval_of(index_y)?;
        let place = self.displaced_place(id, self.turned.row(y)[x]);
        let rank = self.rank_in(&varied.turned, id);
        Some(varied.kinds.kind(rank, place.map(|k| self.world(k))))
    }
}
