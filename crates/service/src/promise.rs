//! Points in flight: those that answers have announced and not made yet.
//!
//! An answer announces its exact number of points before it makes the first. That number joins a total of all answers.
//! Each block that is made leaves the total, and the rest leaves with the answer.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

/// The points that all answers in progress have announced and not made yet. Cheap to clone.
#[derive(Clone, Debug, Default)]
pub struct PointsInFlight(Arc<AtomicU64>);

impl PointsInFlight {
    pub fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    pub(super) fn promise(&self, points: u64) -> Promise {
        self.0.fetch_add(points, Ordering::Relaxed);
        Promise {
            all: self.clone(),
            rest: points.into(),
        }
    }
}

/// The points that one answer still has to make; they no longer count once this is dropped.
#[derive(Debug)]
pub(super) struct Promise {
    all: PointsInFlight,
    rest: AtomicU64,
}

impl Promise {
    pub(super) fn keep(&self, points: u64) {
        let less = |rest: u64| Some(rest.saturating_sub(points));
        let (set, fetch) = (Ordering::Relaxed, Ordering::Relaxed);
        let before = self.rest.fetch_update(set, fetch, less).unwrap_or(0);
        self.all.0.fetch_sub(before.min(points), Ordering::Relaxed);
    }
}

impl Drop for Promise {
    fn drop(&mut self) {
        self.all
            .0
            .fetch_sub(*self.rest.get_mut(), Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn promises_add_up_until_they_are_kept_or_dropped() {
        let all = PointsInFlight::default();
        let (first, second) = (all.promise(100), all.promise(10));
        assert_eq!(all.get(), 110);
        first.keep(30);
        assert_eq!(all.get(), 80);
        // More than was announced takes nothing from others.
        second.keep(11);
        assert_eq!(all.get(), 70);
        drop(first);
        drop(second);
        assert_eq!(all.get(), 0);
    }
}
