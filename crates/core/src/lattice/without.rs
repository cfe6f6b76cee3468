//! The ids of points that a set leaves out.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

/// Lists of ids, each sorted.
#[derive(Clone, Debug)]
pub(crate) struct Without<Id>(Vec<Arc<[Id]>>);

impl<Id> Default for Without<Id> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<Id: Copy + Ord> Without<Id> {
    /// Leaves out the ids of another list, too.
    pub(crate) fn push(&mut self, mut ids: Arc<[Id]>) {
        if !ids.is_sorted() {
            let mut sorted = ids.to_vec();
            sorted.sort_unstable();
            ids = sorted.into();
        }
        self.0.push(ids);
    }

    /// Whether nothing is left out.
    pub(crate) const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether a point is left out.
    #[inline]
    pub(crate) fn has(&self, id: Id) -> bool {
        self.0.iter().any(|ids| ids.binary_search(&id).is_ok())
    }

    /// Whether another set leaves out the same lists.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let mut lists = self.0.iter().zip(&other.0);
        self.0.len() == other.0.len() && lists.all(|(own, other)| Arc::ptr_eq(own, other))
    }

    /// The ids of a range, in order in each list; several lists may have the same.
    pub(crate) fn within(&self, range: Range<Id>) -> impl Iterator<Item = Id> + '_ {
        self.0.iter().flat_map(move |ids| {
            let start = ids.partition_point(|id| *id < range.start);
            let end = ids.partition_point(|id| *id < range.end);
            ids[start..end.max(start)].iter().copied()
        })
    }
}
