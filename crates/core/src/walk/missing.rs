//! The points of a scope that are left out by their ids.
//!
//! They are found once, when the scope is made: those that would be among its points. So a count is that of all points
//! less theirs, and walks meet each of them as a run of one column that does not pass.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use super::{
    scope::Scope,
    sieve::{LocalSieve, Run, Sieve},
};
use crate::{
    lattice::{BAND_WIDTH, PointId},
    shape::Area,
};

/// Points in the order of their scope.
#[derive(Clone, Debug, Default)]
pub(crate) struct Missing(Arc<[PointId]>);

/// The place of an address in the order.
const fn order(id: &PointId) -> (i64, i64, i64) {
    (id.x.div_euclid(BAND_WIDTH), id.y, id.x)
}

/// So many points are compared with a whole area; more are halved, and the area with them.
const TOGETHER: usize = 16;

impl Missing {
    /// The points of a scope that its lattice leaves out by their ids. Meaningless once its flag is raised.
    pub(super) fn new(scope: &Scope) -> Self {
        let Scope { lattice, x, y, .. } = scope;
        if lattice.without.is_empty() {
            return Self::default();
        }
        let [start, end] = [x.all.start, x.all.end].map(|x| PointId { x, y: i64::MIN });
        let near = lattice.without.within(start..end);
        let mut all: Vec<PointId> = near.filter(|id| y.all.contains(&id.y)).collect();
        // Several lists may have the same.
        all.sort_unstable_by_key(order);
        all.dedup();
        let mut found = Vec::new();
        if lattice.settle().is_some() {
            // Where they end does not matter: they are left out of counts of parts all of which is inside.
            found = all;
            found.retain(|id| {
                let share = lattice.share_of(*id);
                share.is_some_and(|share| lattice.is_of_level(*id, share))
            });
        } else {
            let sieve = scope.sieve.as_ref().map(Sieve::local);
            let area = scope.sieve.as_ref().and_then(Sieve::area);
            scope.keep_inside(sieve.as_ref(), area, &all, &mut found);
        }
        Self(found.into())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether a point of the scope is left out.
    #[inline]
    pub(super) fn has(&self, id: PointId) -> bool {
        !self.is_empty() && self.0.binary_search_by_key(&order(&id), order).is_ok()
    }

    /// Those in some rows of the band of a column.
    fn in_band(&self, x: i64, rows: &Range<i64>) -> &[PointId] {
        let band = x.div_euclid(BAND_WIDTH);
        let [start, end] = [rows.start, rows.end].map(|y| {
            let first = (band, y, i64::MIN);
            self.0.partition_point(|id| order(id) < first)
        });
        &self.0[start..end.max(start)]
    }

    /// The number of those with addresses in some columns and rows.
    pub(super) fn count(&self, columns: &Range<i64>, rows: &Range<i64>) -> u128 {
        let [start, end] = [columns.start, columns.end - 1].map(|x| x.div_euclid(BAND_WIDTH));
        let near = match start == end {
            true => self.in_band(columns.start, rows),
            false => &self.0,
        };
        let is_there = |id: &&PointId| columns.contains(&id.x) && rows.contains(&id.y);
        near.iter().filter(is_there).count() as u128
    }

    /// Makes the columns of those in some rows runs of their own, which do not pass. All columns lie in one band.
    pub(super) fn cut(&self, rows: &Range<i64>, columns: &Range<i64>, runs: &mut Vec<Run>) {
        let mut at: Vec<i64> = self
            .in_band(columns.start, rows)
            .iter()
            .map(|id| id.x)
            .collect();
        at.sort_unstable();
        at.dedup();
        for x in at {
            let Some(place) = runs.iter().position(|run| run.columns.contains(&x)) else {
                continue;
            };
            if !runs[place].passes {
                continue;
            }
            let run = runs.remove(place);
            let parts = [
                (run.columns.start..x, true),
                (x..x + 1, false),
                (x + 1..run.columns.end, true),
            ];
            let parts = parts.into_iter().filter(|(columns, _)| !columns.is_empty());
            let parts = parts.map(|(columns, passes)| Run {
                columns,
                passes,
                near: None,
            });
            runs.splice(place..place, parts);
        }
    }
}

impl Scope {
    /// Adds those of some points of the lattice that the scope would have, which are in its order.
    fn keep_inside(
        &self,
        sieve: Option<&LocalSieve>,
        area: Option<&Area>,
        ids: &[PointId],
        found: &mut Vec<PointId>,
    ) {
        if self.stop.is_raised() || area.is_some_and(|area| area.is_all_or_nothing() == Some(false))
        {
            return;
        }
        if ids.len() > TOGETHER {
            for half in [&ids[..ids.len() / 2], &ids[ids.len() / 2..]] {
                let near = sieve.zip(area).map(|(sieve, area)| {
                    let [columns, rows] = [|id: &PointId| id.x, |id: &PointId| id.y].map(|v| {
                        let all = || half.iter().map(v);
                        all().min().unwrap_or(0)..all().max().unwrap_or(0) + 1
                    });
                    area.focus(&sieve.world([&columns, &rows]))
                });
                self.keep_inside(sieve, near.as_ref(), half, found);
            }
            return;
        }
        let is_inside = |id: &&PointId| {
            let Some(place) = self.lattice.place_of_any(**id) else {
                return false;
            };
            let at = place.map(|k| self.lattice.world(k));
            let bounds = [&self.x.bounds, &self.y.bounds];
            (0..2).all(|axis| bounds[axis].contains(&place[axis]))
                && area.is_none_or(|area| area.contains(at))
                && sieve.is_none_or(|sieve| sieve.is_clear(at))
        };
        found.extend(ids.iter().filter(is_inside));
    }
}
