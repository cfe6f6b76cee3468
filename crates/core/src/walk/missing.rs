//! The points of a scope that are left out by their ids.
//!
//! They are found once, when the scope is made: those that would be among its points. So a count is that of all points
//! less theirs, and walks meet each of them as a run of one column that does not pass.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use crate::{
    lattice::{BAND_WIDTH, PointId},
    sort,
};

/// Points in the order of their scope.
#[derive(Clone, Debug, Default)]
pub(crate) struct Missing(pub(super) Arc<[PointId]>);

/// The place of an address in the order.
const fn order(id: &PointId) -> (i64, i64, i64) {
    (id.x.div_euclid(BAND_WIDTH), id.y, id.x)
}

impl Missing {
    /// Some points, in any order, several of which may be the same.
    pub(super) fn in_order(mut ids: Vec<PointId>) -> Vec<PointId> {
        sort::by_key(&mut ids, order);
        ids.dedup();
        ids
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

    /// The columns of those in some rows of the band of a column, each once.
    pub(super) fn columns(&self, x: i64, rows: &Range<i64>) -> Vec<i64> {
        let mut at: Vec<i64> = self.in_band(x, rows).iter().map(|id| id.x).collect();
        sort::by_key(&mut at, |&x| x);
        at.dedup();
        at
    }
}
