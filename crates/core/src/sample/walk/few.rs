//! The points of small plans: they are found while they are counted, and not looked for again.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use super::{
    bands::{Bands, format_of, write_found},
    rows::RowWalk,
};
use crate::sample::{
    kernel::{Backend, Exact, Format},
    lattice::{Found, PointId},
    scope::Scope,
    sieve::Scale,
};

/// The most points of a small plan: 12 bytes each.
pub(super) const FEW: usize = 2048;

/// The points of a plan in their order, patch by patch.
#[derive(Clone, Debug, Default)]
pub(crate) struct Few {
    /// The origins of the patches, and the number of points before each.
    patches: Vec<([i64; 2], usize)>,
    found: Vec<Found>,
}

impl Few {
    /// Adds points of a patch, after all others.
    pub(super) fn add(&mut self, origin: [i64; 2], found: impl Iterator<Item = Found>) {
        if self.patches.last().is_none_or(|&(last, _)| last != origin) {
            self.patches.push((origin, self.found.len()));
        }
        self.found.extend(found);
    }

    /// The memory that this takes.
    pub(crate) const fn bytes(&self) -> usize {
        size_of::<Found>() * self.found.capacity()
            + size_of::<([i64; 2], usize)>() * self.patches.capacity()
    }

    /// The number of points.
    pub(crate) const fn len(&self) -> usize {
        self.found.len()
    }

    /// The patch of point number `k`: its origin, and the number of the first point after it.
    fn patch(&self, k: usize) -> Option<([i64; 2], usize)> {
        let after = self.patches.partition_point(|&(_, before)| before <= k);
        let (origin, _) = self.patches.get(after.checked_sub(1)?)?;
        let end = self.patches.get(after);
        Some((*origin, end.map_or(self.len(), |&(_, before)| before)))
    }

    /// The address of point number `k`; `None` from the end on.
    pub(crate) fn id(&self, k: usize) -> Option<PointId> {
        let [x, y] = self.found.get(k)?.address();
        let ([left, bottom], _) = self.patch(k)?;
        Some(PointId {
            x: left + x,
            y: bottom + y,
        })
    }
}

/// The points of a small plan that are still to be written.
#[derive(Clone, Debug)]
pub(super) struct Kept<F> {
    few: Arc<Few>,
    /// The number of the next point.
    next: usize,
    format: F,
    pub(super) backend: Backend,
}

impl<F: Format> Kept<F> {
    /// The points from number `next` on.
    pub(super) fn new(scope: &Scope, few: Arc<Few>, next: usize) -> Self {
        Self {
            few,
            next,
            format: format_of(scope),
            backend: Backend::best(),
        }
    }

    /// The address of the next point: after the last one, any later address. `None` if there are no points.
    pub(super) fn place(&self) -> Option<PointId> {
        let after = || {
            let last = self.few.id(self.few.len().checked_sub(1)?)?;
            Some(PointId {
                x: last.x + 1,
                ..last
            })
        };
        self.few.id(self.next).or_else(after)
    }

    /// Fills `out` with the next points, and only a part of it at the end. Returns the number written.
    pub(super) fn fill(&mut self, out: &mut [F::Item]) -> usize {
        let mut written = 0;
        while self.next < self.few.len()
            && written < out.len()
            && let Some((origin, end)) = self.few.patch(self.next)
        {
            let number = (out.len() - written).min(end - self.next);
            let found = self.few.found[self.next..][..number].iter().copied();
            let by = (&self.format, self.backend);
            write_found(by, origin, found, &mut out[written..]);
            self.next += number;
            written += number;
        }
        written
    }
}

/// The most points of a plan that keeps clear of other sets: testing them again costs more.
pub(super) const FEW_GUARDED: usize = 8192;

/// The points that are listed between two looks at the flag, where each is tested against other sets.
const GUARDED: usize = 256;

/// The points of a small box that is warped or keeps clear of other sets. `None` if it is not small, or no such box.
pub(super) fn find_few(scope: &Arc<Scope>) -> Option<Few> {
    let Scope { lattice, x, y, .. } = &**scope;
    if lattice.grade.is_some() {
        return None;
    }
    let (guards, most) = match &scope.sieve {
        Some(sieve) => (sieve.guards_alone()?, FEW_GUARDED),
        None if lattice.shears.is_some() => (Vec::new(), FEW),
        None => return None,
    };
    let length = |range: &Range<i64>| (range.end as f64 - range.start as f64).max(0.0);
    // The share of lattice places that have a point.
    let side = lattice.map().alpha().set_side() as f64 / 18_446_744_073_709_551_616.0;
    let expected = length(&x.all) * length(&y.all) * side * side;
    if expected > most as f64 {
        return None;
    }
    let of_box = match &scope.sieve {
        Some(_) => Arc::new(scope.of_box()),
        None => scope.clone(),
    };
    let mut walk = RowWalk::<Exact>::new(Bands::from(of_box, None), None);
    if !walk.is_flat() {
        return None;
    }
    let mut few = Few {
        found: Vec::with_capacity(expected as usize),
        ..Few::default()
    };
    let enough = if guards.is_empty() { FEW } else { GUARDED };
    while let Some((origin, found)) = walk.list(enough) {
        if guards.is_empty() {
            few.add(origin, found);
            continue;
        }
        if scope.stop.is_raised() {
            break;
        }
        let scale = Scale::at(lattice, origin);
        let permitted = found.filter(|found| {
            let at = scale.world(found.place);
            guards.iter().all(|guard| guard.permits(at))
        });
        few.add(origin, permitted);
    }
    Some(few)
}
