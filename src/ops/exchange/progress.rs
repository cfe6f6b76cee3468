//! Whether a client takes its answer: at once, or at least at a minimum rate.
//!
//! A client has `patience` to take something. Each byte that the socket takes earns it the time that
//! the byte would need at the minimum rate, up to `patience` again. So bursts and pauses are fine, a
//! client that takes nothing is over after `patience`, and one that is slower than the rate on average
//! is over some time later. While the client waits for us, the clock stands still.

use std::time::Duration;

use tokio::time::Instant;

/// The time that an answer may take.
#[derive(Clone, Copy, Debug)]
pub(in crate::ops) struct Terms {
    /// The time in which a client must take something.
    pub(super) patience: Duration,
    /// The least rate, in bytes per second; 0 for none.
    pub(super) rate: f64,
    /// The most time from the head of the request to the last byte.
    pub(super) whole: Duration,
}

/// The clock of one answer.
#[derive(Debug)]
pub(super) struct Progress {
    terms: Terms,
    deadline: Option<Instant>,
    /// Since when the client waits for us.
    paused: Option<Instant>,
}

impl Progress {
    /// A clock that stands still: the client waits for the head of the answer.
    pub(super) fn new(terms: Terms, now: Instant) -> Self {
        Self {
            deadline: now.checked_add(terms.patience),
            paused: Some(now),
            terms,
        }
    }

    /// The client waits for us.
    pub(super) fn pause(&mut self, now: Instant) {
        self.paused.get_or_insert(now);
    }

    /// There is something to take.
    pub(super) fn resume(&mut self, now: Instant) {
        let Some(since) = self.paused.take() else {
            return;
        };
        let later = |at: Instant| at.checked_add(now.saturating_duration_since(since));
        self.deadline = self.deadline.and_then(later);
    }

    /// The socket took bytes.
    pub(super) fn taken(&mut self, bytes: usize, now: Instant) {
        let full = now.checked_add(self.terms.patience);
        let earned = bytes as f64 / self.terms.rate;
        let earned = Duration::try_from_secs_f64(earned).unwrap_or(Duration::MAX);
        let later = self.deadline.and_then(|at| at.checked_add(earned));
        self.deadline = match (later, full) {
            (Some(later), Some(full)) => Some(later.min(full)),
            (_, full) => full,
        };
    }

    /// Whether the client has taken too little for too long.
    pub(super) fn is_over(&self, now: Instant) -> bool {
        self.paused.is_none() && self.deadline.is_some_and(|at| at <= now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn clock(rate: f64) -> (Progress, Instant) {
        let terms = Terms {
            patience: 60 * SECOND,
            rate,
            whole: Duration::MAX,
        };
        let start = Instant::now();
        (Progress::new(terms, start), start)
    }

    #[test]
    fn a_client_that_waits_is_not_at_fault() {
        let (mut clock, start) = clock(1000.0);
        assert!(!clock.is_over(start + 1000 * SECOND));
        clock.resume(start + 1000 * SECOND);
        assert!(!clock.is_over(start + 1059 * SECOND));
        assert!(clock.is_over(start + 1060 * SECOND));
    }

    #[test]
    fn a_client_that_is_slower_than_the_rate_is_over_in_the_end() {
        for (every, bytes, is_fine) in [
            (50, 51_000, true),
            (1, 1001, true),
            (1, 900, false),
            (50, 10_000, false),
            // A burst earns no more than the patience.
            (70, 1 << 30, false),
        ] {
            let (mut clock, start) = clock(1000.0);
            clock.resume(start);
            let over = (0..1000).step_by(every).skip(1).any(|at| {
                let now = start + at as u32 * SECOND;
                let is_over = clock.is_over(now);
                clock.taken(bytes, now);
                is_over
            });
            assert_eq!(!over, is_fine, "{bytes} bytes every {every} s");
        }
    }

    #[test]
    fn without_a_rate_anything_is_progress() {
        let (mut clock, start) = clock(0.0);
        clock.resume(start);
        for at in 1..100 {
            let now = start + 59 * at * SECOND;
            assert!(!clock.is_over(now));
            clock.taken(1, now);
        }
    }
}
