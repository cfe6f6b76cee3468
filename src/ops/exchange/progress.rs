//! Whether a client takes its answer, at once or at least at a minimum rate; and the fate of a connection whose client takes
//! nothing of all its answers.
//!
//! A client has `patience` to take something. Each byte that the socket takes earns it the time that
//! the byte would need at the minimum rate, up to `patience` again. So bursts and pauses are fine, a
//! client that takes nothing is over after `patience`, and one that is slower than the rate on average
//! is over some time later. While the client waits for us, the clock stands still.

use std::{
    sync::{Arc, Weak},
    time::Duration,
};

use parking_lot::Mutex;
use tokio::time::Instant;

#[derive(Clone, Copy, Debug)]
pub(in crate::ops) struct Terms {
    /// The time in which a client must take something.
    pub(super) patience: Duration,
    /// The least rate, in bytes per second; 0 for none.
    pub(super) rate: f64,
    /// The most time from the head of the request to the last byte.
    pub(super) whole: Duration,
}

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

pub(super) trait Timed: Send + Sync {
    /// Breaks the answer off if its time is over. Returns when it was broken off, if it was.
    fn check(&self, now: Instant) -> Option<Instant>;
}

#[derive(Debug)]
pub(in crate::ops) struct OpenExchanges(Mutex<Open>);

#[derive(Debug)]
struct Open {
    exchanges: Vec<Weak<dyn Timed>>,
    /// When the last one began or ended.
    changed: Instant,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ops) enum Fate {
    GoOn,
    /// There has been no request for long, or clients left answers untouched that were broken off:
    /// it takes no more requests and ends with those that it has.
    Retire,
    /// All of its answers were broken off: it ends now.
    Close,
}

/// The time for sending the end of an answer that was broken off.
const ENDING_TIME: Duration = Duration::from_secs(1);
const LONGEST: Duration = Duration::from_secs(5);

impl OpenExchanges {
    pub(in crate::ops) fn new() -> Arc<Self> {
        Arc::new(Self(Mutex::new(Open {
            exchanges: vec![],
            changed: Instant::now(),
        })))
    }

    pub(super) fn begun(&self, exchange: Weak<dyn Timed>, now: Instant) {
        let mut open = self.0.lock();
        open.exchanges.push(exchange);
        open.changed = now;
    }

    /// An exchange is being dropped.
    pub(super) fn ended(&self) {
        let mut open = self.0.lock();
        open.exchanges.retain(|one| one.strong_count() > 0);
        open.changed = Instant::now();
    }

    /// Checks the exchanges from time to time. Returns when the connection should not simply go on:
    /// because of what they do, or because there is none.
    pub(in crate::ops) async fn decided(
        &self,
        idle: Duration,
        patience: Duration,
        is_closing: bool,
    ) -> Fate {
        let step = (idle.min(patience) / 4).clamp(Duration::from_millis(10), LONGEST);
        loop {
            tokio::time::sleep(step).await;
            let fate = self.fate(Instant::now(), idle, patience);
            // One that retires already can only be closed.
            if fate == Fate::Close || fate == Fate::Retire && !is_closing {
                return fate;
            }
        }
    }

    fn fate(&self, now: Instant, idle: Duration, patience: Duration) -> Fate {
        let open = self.0.lock();
        let changed = open.changed;
        let all: Vec<_> = open.exchanges.iter().filter_map(Weak::upgrade).collect();
        drop(open);
        if all.is_empty() {
            let quiet = now.saturating_duration_since(changed);
            return if quiet >= idle {
                Fate::Retire
            } else {
                Fate::GoOn
            };
        }
        let broken: Vec<Instant> = all.iter().filter_map(|one| one.check(now)).collect();
        let since = |at: Option<&Instant>| at.map(|&at| now.saturating_duration_since(at));
        let newest = since(broken.iter().max());
        if broken.len() == all.len() && newest.is_some_and(|age| age >= ENDING_TIME.min(patience)) {
            return Fate::Close;
        }
        let oldest = since(broken.iter().min());
        if oldest.is_some_and(|age| age >= patience) {
            return Fate::Retire;
        }
        Fate::GoOn
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
