//! The points that keep clear of other sets.

use alloc::{boxed::Box, sync::Arc};
use core::ops::Range;

use super::{
    Batch, Region, Volume,
    lattice::{Lattice, fixed},
    mask::{Mask, Other},
    point::{Point, PointId},
    scope::Scope,
    settled::{self, SettledWalk},
    walk::{Walk, few},
};
use crate::{
    error::Error,
    kernel::Backend,
    near::clear::{Clear, ClearOf, MOST_SPACINGS, OtherSet},
    stop::Stop,
};

impl Other {
    /// A distance from all points that a lattice and a mask leave, in world units.
    pub(super) fn kept(
        lattice: &Lattice,
        mask: &Mask,
        distance: f64,
    ) -> Result<ClearOf<Self>, Error> {
        let (lattice, mask) = (lattice.whole(), mask.clone());
        ClearOf::new(Self { lattice, mask }, distance)
    }
}

impl OtherSet<3> for Other {
    fn spacing(&self) -> f64 {
        self.lattice.placement.spacing.get()
    }

    fn spacing_kept(&self) -> f64 {
        self.lattice.spacing_kept()
    }

    fn sides(&self) -> [f64; 3] {
        /// In mean spacings. They are flat because walks go plane by plane.
        const TILE: [f64; 3] = [16.0, 16.0, 2.0];
        /// Those of thinned sets grow up to this factor.
        const THINNED: f64 = 4.0;
        let wide = (self.spacing_kept() / self.spacing()).min(THINNED);
        TILE.map(|side| side * self.spacing() * wide)
    }

    fn searches(&self, sides: [f64; 3], _: f64) -> u32 {
        /// The points whose making costs as much as a search.
        const SEARCH: f64 = 128.0;
        let points: f64 = sides
            .iter()
            .map(|side| side / self.spacing_kept())
            .product();
        (points / SEARCH) as u32
    }

    fn is_same(&self, other: &Self) -> bool {
        self.lattice.is_same(&other.lattice) && self.mask.is_same(&other.mask)
    }

    fn clear(&self) -> &[ClearOf<Self>] {
        &self.mask.clear
    }

    fn limit(&self) -> f64 {
        // A place beyond its points may be near them.
        self.lattice.limit() + 2.0 * MOST_SPACINGS * self.spacing()
    }

    fn visit(&mut self, region: &Region, stop: &Stop, mut each: impl FnMut([f64; 3]) -> bool) {
        let limit = self.lattice.limit();
        let [min, max] = [region.min(), region.max()].map(|v| v.map(|v| v.clamp(-limit, limit)));
        let region = Region::between(min, max);
        // The part of the mask that other sets do not decide, as it matters in the box.
        let mut mask = Mask {
            area: self.mask.area.clone(),
            clear: Arc::default(),
        };
        // Reported coordinates do not decide about chunks.
        if let Some(area) = (self.mask.area.as_ref()).filter(|area| area.chunks().is_empty()) {
            let near = area.focus(&region);
            match near.is_all_or_nothing() {
                Some(false) => return,
                Some(true) => mask.area = None,
                None => mask.area = Some(Arc::new(near)),
            }
        }
        let volume = Volume::Region(region);
        // Beyond the limit there are no points.
        let Ok(scope) = Scope::new(&self.lattice, &mask, &volume, stop.clone()) else {
            return;
        };
        let scope = Arc::new(scope);
        let mut all =
            |batch: &Batch| (0..batch.len()).all(|i| each(self.lattice.at(batch.place(i))));
        let few = if scope.is_small() { few(&scope) } else { None };
        if let Some(few) = few {
            all(&few);
            return;
        }
        let mut walk = AnyWalk::new(scope.clone(), &scope.all, None, false);
        let mut batch = Batch::default();
        while walk.next(&mut batch) && all(&batch) {}
    }
}

/// Removes the points of a batch of a scope that are too near others.
pub(super) fn sift(scope: &Scope, clear: &mut Clear<Other, 3>, batch: &mut Batch) {
    if clear.is_empty() || scope.stop.is_raised() {
        return;
    }
    let origin = batch.origin;
    batch.retain(|place| {
        let place = |axis| fixed(origin[axis]) + i64::from(place[axis]);
        clear.permits(scope.lattice.at([0, 1, 2].map(place)))
    });
}

/// A walk over the points of a scope, whether they settle or stay.
#[derive(Clone, Debug)]
pub(super) enum AnyWalk {
    Still(Box<Walk>, Box<Clear<Other, 3>>),
    Settled(Box<SettledWalk>),
}

impl AnyWalk {
    /// As [`Walk::new`].
    pub(super) fn new(
        scope: Arc<Scope>,
        ranges: &[Range<i64>; 3],
        start: Option<[i64; 3]>,
        wants_ids: bool,
    ) -> Self {
        match SettledWalk::new(&scope, ranges, start) {
            Some(walk) => Self::Settled(Box::new(walk)),
            None => {
                let clear = Box::new(scope.clearance());
                Self::Still(Box::new(Walk::new(scope, ranges, start, wants_ids)), clear)
            }
        }
    }

    pub(super) fn set_backend(&mut self, backend: Backend) {
        match self {
            Self::Still(walk, _) => walk.backend = backend,
            Self::Settled(walk) => walk.pieces.settler.set_backend(backend),
        }
    }

    /// Fills a batch with the next points, at least one. Returns false if there are none, and once the scope's flag is
    /// raised: what points keep clear of is not known then.
    pub(super) fn next(&mut self, out: &mut Batch) -> bool {
        match self {
            Self::Still(walk, clear) => {
                while walk.next(out) {
                    sift(walk.scope(), clear, out);
                    if !out.is_empty() {
                        return !walk.scope().stop.is_raised();
                    }
                }
                false
            }
            Self::Settled(walk) => walk.next(out) && !walk.pieces.inside.request.stop.is_raised(),
        }
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
    let mut walk = AnyWalk::new(scope.clone(), &scope.all, None, true);
    let mut batch = Batch::default();
    while walk.next(&mut batch) {
        let mut addresses = (0..batch.len()).map(|i| batch.address(i));
        if addresses.any(|address| address == Some(id.lattice())) {
            return Some(point);
        }
    }
    None
}
