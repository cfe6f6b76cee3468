//! The clock of a request, which stands still while its work waits for a turn.

use std::time::{Duration, Instant};

use parking_lot::Mutex;

#[derive(Debug, Default)]
pub struct Clock(Mutex<Waited>);

#[derive(Debug, Default)]
struct Waited {
    /// The work of the request that waits now, and since when it does.
    waiting: usize,
    since: Option<Instant>,
    before: Duration,
}

impl Clock {
    /// How long the request has waited so far.
    pub fn waited(&self) -> Duration {
        let waited = self.0.lock();
        waited.before + waited.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    pub(super) fn wait(&self) {
        let mut waited = self.0.lock();
        waited.waiting += 1;
        waited.since.get_or_insert_with(Instant::now);
    }

    /// Some of its work waits no longer.
    pub(super) fn go_on(&self) {
        let mut waited = self.0.lock();
        waited.waiting -= 1;
        if waited.waiting == 0
            && let Some(since) = waited.since.take()
        {
            waited.before += since.elapsed();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_waits_while_any_of_its_work_does() {
        let clock = Clock::default();
        clock.wait();
        clock.wait();
        clock.go_on();
        assert!(clock.0.lock().since.is_some());
        clock.go_on();
        let waited = clock.waited();
        assert!(clock.0.lock().since.is_none() && clock.waited() == waited);
    }
}
