//! Log lines about events that may happen a thousand times a second: one line an interval, with the
//! number of events.

use std::time::{Duration, Instant};

use parking_lot::Mutex;

/// The time between two lines.
const INTERVAL: Duration = Duration::from_secs(10);

/// Counts events and says when to log them.
#[derive(Debug, Default)]
pub(super) struct LogThrottle {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    count: u64,
    logged: Option<Instant>,
}

impl LogThrottle {
    /// Records one event. Returns the number of events since the last line if it is time for
    /// another.
    pub(super) fn record(&self) -> Option<u64> {
        let mut state = self.state.lock();
        state.count += 1;
        if state.logged.is_some_and(|at| at.elapsed() < INTERVAL) {
            return None;
        }
        state.logged = Some(Instant::now());
        Some(std::mem::take(&mut state.count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_event_is_logged_and_the_next_are_counted() {
        let throttle = LogThrottle::default();
        assert_eq!(throttle.record(), Some(1));
        assert_eq!([throttle.record(), throttle.record()], [None, None]);
        let earlier = Instant::now().checked_sub(INTERVAL);
        throttle.state.lock().logged = earlier;
        let expected = if earlier.is_some() { 3 } else { 4 };
        assert_eq!(throttle.record(), Some(expected));
    }
}
