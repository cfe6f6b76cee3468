//! The clock of a request, which stands still while its work waits for a turn.

use std::{
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};

/// How long a request has waited for turns.
#[derive(Debug, Default)]
pub struct Clock(Mutex<Waited>);

#[derive(Debug, Default)]
struct Waited {
    /// The work of the request that waits now, and since when it does.
    waiting: usize,
    since: Option<Instant>,
    /// The time of waits that are over.
    before: Duration,
}

impl Clock {
    /// How long the request has waited so far.
    #[must_use]
    pub fn waited(&self) -> Duration {
        let waited = self.lock();
        waited.before + waited.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    fn wait(&self) {
        let mut waited = self.lock();
        waited.waiting += 1;
        waited.since.get_or_insert_with(Instant::now);
    }

    fn go_on(&self) {
        let mut waited = self.lock();
        waited.waiting -= 1;
        if waited.waiting == 0
            && let Some(since) = waited.since.take()
        {
            waited.before += since.elapsed();
        }
    }

    fn lock(&self) -> MutexGuard<'_, Waited> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Work that waits for its turn, until this is dropped.
#[derive(Debug)]
pub(super) struct Waiting(Option<Arc<Clock>>);

impl Waiting {
    /// Work of the request that has this clock, if it has one.
    pub(super) fn of(clock: Option<Arc<Clock>>) -> Self {
        if let Some(clock) = &clock {
            clock.wait();
        }
        Self(clock)
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some(clock) = &self.0 {
            clock.go_on();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_waits_while_any_of_its_work_does() {
        let clock = Arc::new(Clock::default());
        let wait = || Waiting::of(Some(clock.clone()));
        let (one, two) = (wait(), wait());
        drop(one);
        assert!(clock.lock().since.is_some());
        drop(two);
        let waited = clock.waited();
        assert!(clock.lock().since.is_none() && clock.waited() == waited);
    }
}
