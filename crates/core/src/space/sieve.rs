//! The walk over the points of a scope that keep clear of other sets.

use alloc::sync::Arc;
use core::ops::Range;

use super::{
    Batch, Region, Volume,
    clearance::Clearance,
    lattice::Lattice,
    mask::Mask,
    point::{Point, PointId},
    scope::Scope,
    settled::{self, AnyWalk},
};
use crate::{sample::Backend, stop::Stop};

/// A walk over the points of a scope that its mask leaves.
#[derive(Clone, Debug)]
pub(super) struct Sifted {
    walk: AnyWalk,
    backend: Backend,
    scope: Arc<Scope>,
    clearance: Clearance,
}

impl Sifted {
    /// As [`AnyWalk::new`].
    pub(super) fn new(
        scope: Arc<Scope>,
        ranges: &[Range<i64>; 3],
        start: Option<[i64; 3]>,
        wants_ids: bool,
    ) -> Self {
        Self {
            walk: AnyWalk::new(scope.clone(), ranges, start, wants_ids),
            clearance: Clearance::new(&scope),
            scope,
            backend: Backend::best(),
        }
    }

    pub(super) fn backend(&self) -> Backend {
        self.backend
    }

    pub(super) fn set_backend(&mut self, backend: Backend) {
        self.backend = backend;
        self.walk.set_backend(backend);
    }

    /// Fills a batch with the next points, at least one. Returns false if there are none.
    pub(super) fn next(&mut self, out: &mut Batch) -> bool {
        while self.walk.next(out) {
            self.clearance.sift(&self.scope, out);
            if !out.is_empty() {
                return true;
            }
        }
        false
    }
}

/// The point of an address that a mask leaves.
pub(super) fn point(lattice: &Lattice, mask: &Mask, id: PointId) -> Option<Point> {
    let point = settled::point(lattice, id)?;
    if mask.is_none() {
        return Some(point);
    }
    let at = point.at();
    let volume = Volume::Region(Region::between(at, at.map(f64::next_up)));
    // Beyond the limit there are no points.
    let scope = Arc::new(Scope::new(lattice, mask, &volume, Stop::default()).ok()?);
    let mut walk = Sifted::new(scope.clone(), &scope.all, None, true);
    let mut batch = Batch::default();
    while walk.next(&mut batch) {
        let mut addresses = (0..batch.len()).map(|i| batch.address(i));
        if addresses.any(|address| address == Some(id.lattice())) {
            return Some(point);
        }
    }
    None
}
