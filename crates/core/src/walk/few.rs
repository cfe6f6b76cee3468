//! The points of small plans: they are found while they are counted, and not looked for again.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use super::{bands::write_found, scope::Scope, sieve::Sieve};
use crate::{
    batch::{Batch, Offset},
    kernel::{Backend, Format},
    lattice::{Flat, Found, PATCH_HEIGHT, Patch, PointId, Scale, clip_to_band},
};

/// The most points of a small plan: 12 bytes each.
pub(super) const FEW: usize = 2048;

/// The most points of a plan that keeps clear of other sets: testing them again costs more.
pub(super) const FEW_GUARDED: usize = 8192;

/// The candidates that are listed between two looks at the flag, where each is tested against other sets.
const GUARDED: usize = 256;

/// The most parts of an area that each candidate is compared with.
const PARTS: usize = 16;

/// The points of a plan in their order, patch by patch.
#[derive(Clone, Debug, Default)]
pub(crate) struct Few {
    patches: Vec<FewOfPatch>,
    found: Batch<2, i32>,
}

/// The points of a patch that follow each other.
#[derive(Clone, Copy, Debug)]
struct FewOfPatch {
    /// The origin of the patch.
    origin: [i64; 2],
    /// The number of rows from there to the row that the points are relative to.
    lift: i32,
    /// The numbers of points before them.
    before: usize,
}

impl Few {
    /// Adds a point of a patch, after all others.
    pub(super) fn add(&mut self, origin: [i64; 2], found: Found) {
        self.begin(origin, 0, 0);
        self.found.push(found);
    }

    /// Notes that another patch begins, some points after those that are there.
    fn begin(&mut self, origin: [i64; 2], lift: i64, after: usize) {
        let lift = lift as i32;
        let is_same = |last: &FewOfPatch| last.origin == origin && last.lift == lift;
        if !self.patches.last().is_some_and(is_same) {
            self.patches.push(FewOfPatch {
                origin,
                lift,
                before: self.found.len() + after,
            });
        }
    }

    /// Adds the points of a band that were found from an origin on, after all others.
    fn add_all(&mut self, found: &mut Batch<2, i32>) {
        let [left, bottom] = found.origin;
        let mut from = 0;
        while let Some([_, y]) = found.address(from) {
            let patch = y & !(PATCH_HEIGHT - 1);
            let rows = patch + PATCH_HEIGHT - bottom;
            self.begin([left, patch], bottom - patch, from);
            from = found.ids.partition_point(|id| i64::from(id >> 16) < rows);
        }
        self.found.append(found);
    }

    /// The memory that this takes.
    pub(crate) fn bytes(&self) -> usize {
        self.found.bytes() + size_of::<FewOfPatch>() * self.patches.capacity()
    }

    /// The number of points.
    pub(crate) fn len(&self) -> usize {
        self.found.len()
    }

    /// The patch of point number `k`, and the number of the first point after it.
    fn patch(&self, k: usize) -> Option<(FewOfPatch, usize)> {
        let after = self.patches.partition_point(|patch| patch.before <= k);
        let patch = self.patches.get(after.checked_sub(1)?)?;
        let end = self.patches.get(after);
        Some((*patch, end.map_or(self.len(), |next| next.before)))
    }

    /// The address of point number `k`; `None` from the end on.
    pub(crate) fn id(&self, k: usize) -> Option<PointId> {
        let [x, y] = self.found.ids.get(k)?.offset();
        let (FewOfPatch { origin, lift, .. }, _) = self.patch(k)?;
        Some(PointId {
            x: origin[0] + x,
            y: origin[1] + i64::from(lift) + y,
        })
    }
}

/// The points of a small plan that are still to be written.
#[derive(Clone, Debug)]
pub(super) struct Kept {
    few: Arc<Few>,
    /// The number of the next point.
    next: usize,
    pub(super) backend: Backend,
}

impl Kept {
    /// The points from number `next` on.
    pub(super) fn new(few: Arc<Few>, next: usize) -> Self {
        Self {
            few,
            next,
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
    pub(super) fn fill<F: Format>(&mut self, format: &F, out: &mut [F::Item]) -> usize {
        let mut written = 0;
        while self.next < self.few.len()
            && written < out.len()
            && let Some((patch, end)) = self.few.patch(self.next)
        {
            let number = (out.len() - written).min(end - self.next);
            let points = self.few.found.points(self.next..self.next + number);
            let points = points.map(|found| found.lifted(patch.lift));
            write_found(
                (format, self.backend),
                patch.origin,
                points,
                &mut out[written..],
            );
            self.next += number;
            written += number;
        }
        written
    }
}

/// The points of a small scope outside fields. `None` if it is not small, or has an area of many parts.
pub(super) fn find_few(scope: &Scope) -> Option<Few> {
    let Scope { lattice, x, y, .. } = scope;
    let area = scope.sieve.as_ref().and_then(Sieve::area);
    if lattice.grade.is_some() || area.is_some_and(|area| area.parts() > PARTS) {
        return None;
    }
    let is_guarded = scope.sieve.as_ref().is_some_and(Sieve::is_guarded);
    let length = |range: &Range<i64>| (range.end as f64 - range.start as f64).max(0.0);
    // The share of lattice places that have a point.
    let side = lattice.map().alpha().set_side_f64();
    let expected = length(&x.all) * length(&y.all) * side * side;
    if expected > if is_guarded { FEW_GUARDED } else { FEW } as f64 {
        return None;
    }
    // A little more than expected, as lists of small patches vary.
    let all = expected as usize + expected as usize / 16 + 32;
    let enough = if is_guarded { GUARDED } else { all };
    let mut sieve = scope.sieve.as_ref().map(|sieve| {
        let mut local = sieve.local();
        local.aim(sieve.area(), &y.all, &x.all);
        local
    });
    let (mut few, mut flat) = <(Few, Flat)>::default();
    for band in scope.bands() {
        let range = clip_to_band(band, &x.all);
        let mut next = y.all.start;
        while next < y.all.end && !scope.stop.is_raised() {
            let patch = Patch::tall(lattice, [band, next], [x, y]);
            let end = y.all.end.min(patch.end());
            while next < end && !scope.stop.is_raised() {
                let by = Backend::best();
                next = flat.list((lattice, &patch), [&range; 2], next..end, enough, by);
                if let Some(sieve) = &mut sieve {
                    sieve.retain(Scale::new(lattice, &patch), &mut flat.found);
                }
                few.add_all(&mut flat.found);
            }
        }
    }
    Some(few)
}

#[cfg(test)]
mod tests {
    use crate::{PointSet, Region, Table};

    #[test]
    fn small_plans_keep_their_points() {
        let alpha = "(5-sqrt(3))/2".parse().expect("valid");
        let table = Table::undisplaced(alpha, 20, "pattern").expect("small");
        let region = Region::new([0.0; 2], [30.0, 31.0]).expect("ordered");
        let plan = PointSet::new(table).within(region).expect("near");
        assert!(plan.kept() > 0);
    }
}
