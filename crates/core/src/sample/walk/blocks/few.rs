//! The points of small plans: they are found while they are counted, and not looked for again.

use alloc::{sync::Arc, vec::Vec};

use super::{Blocks, Place};
use crate::sample::{
    kernel::{F64, Format, compiled},
    lattice::{Found, PointId},
    scope::Scope,
    walk::window::Window,
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

    /// The address of point number `k`, if there are as many.
    pub(crate) fn id(&self, k: usize) -> Option<PointId> {
        let [x, y] = self.found.get(k)?.address();
        let ([left, bottom], _) = self.patch(k)?;
        Some(PointId {
            x: left + x,
            y: bottom + y,
        })
    }
}

impl<F: Format> Blocks<F> {
    /// The points of a window, which were kept when they were counted.
    pub(crate) fn of_kept(scope: Arc<Scope>, window: Window, kept: Arc<Few>) -> Self {
        let mut blocks = Self::new(scope, Some(window), 0..0, 0..0);
        blocks.kept = Some((kept, window.offset as usize));
        blocks
    }

    /// The place of the next point that was kept: after the last one, any later place.
    pub(super) fn kept_place(&self) -> Option<PointId> {
        let (kept, next) = self.kept.as_ref()?;
        let after = || {
            let last = kept.id(kept.len().checked_sub(1)?)?;
            Some(PointId {
                x: last.x + 1,
                ..last
            })
        };
        kept.id(*next).or_else(after)
    }

    /// Writes the next of the points that were kept, as many as there is room for.
    pub(super) fn write_kept(&mut self, out: &mut [F::Item]) -> usize {
        let Some((kept, next)) = &mut self.kept else {
            return 0;
        };
        let mut written = 0;
        while let Some((origin, end)) = kept.patch(*next).filter(|_| *next < kept.len()) {
            let (format, base, [left, bottom]) = (&self.format, self.format.base(origin), origin);
            let out = &mut out[written..];
            let number = out.len().min(end - *next);
            if number == 0 {
                break;
            }
            let found = &kept.found[*next..*next + number];
            compiled(self.backend, || {
                for (out, found) in out.iter_mut().zip(found) {
                    let [x, y] = found.address();
                    let column = format.column(base, found.place[0], left + x);
                    *out = format.item(base, column, found.place[1], bottom + y);
                }
            });
            *next += number;
            written += number;
        }
        written
    }
}

/// The points of a small warped box. `None` if it is not small, or no warped box.
pub(crate) fn find_few(scope: &Arc<Scope>) -> Option<Few> {
    let Scope { lattice, x, y, .. } = &**scope;
    if lattice.shears.is_none() || lattice.grade.is_some() || scope.sieve.is_some() {
        return None;
    }
    let length = |range: &core::ops::Range<i64>| (range.end as f64 - range.start as f64).max(0.0);
    // The share of lattice places that have a point.
    let side = lattice.map().alpha().set_side() as f64 / 18_446_744_073_709_551_616.0;
    let expected = length(&x.all) * length(&y.all) * side * side;
    if expected > FEW as f64 {
        return None;
    }
    let window = Window {
        start: None,
        offset: 0,
        count: u128::MAX,
        total: u128::MAX,
    };
    let mut blocks = Blocks::<F64>::of_window(scope.clone(), window);
    let mut few = Few {
        found: Vec::with_capacity(expected as usize),
        ..Few::default()
    };
    while blocks.at.y < blocks.rows.end || blocks.next_band() {
        if blocks.needs_patch() {
            blocks.next_patch();
        }
        let end = blocks.rows.end.min(blocks.patch.end());
        if !blocks.patch.is_warped() || !blocks.templates.are_short() {
            return None;
        }
        let next = blocks.list_flat(end, FEW);
        let origin = blocks.patch.origin();
        let (_, inside) = &blocks.flat;
        few.add(origin, inside.points());
        blocks.at = Place::row(next);
    }
    Some(few)
}
