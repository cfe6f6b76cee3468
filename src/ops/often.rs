//! What may happen a thousand times a second, in the log once an interval, with how often it was.

use std::{
    sync::{Mutex, PoisonError},
    time::{Duration, Instant},
};

/// How long the log is left alone.
const INTERVAL: Duration = Duration::from_secs(10);

/// Counts something; says when it is time to say how often it was.
#[derive(Debug, Default)]
pub(super) struct Often {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    count: u64,
    said: Option<Instant>,
}

impl Often {
    /// It happened once more: how often since the log last heard of it, if the log is to hear now.
    pub(super) fn once_more(&self) -> Option<u64> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.count += 1;
        if state.said.is_some_and(|said| said.elapsed() < INTERVAL) {
            return None;
        }
        state.said = Some(Instant::now());
        Some(std::mem::take(&mut state.count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_is_said_and_the_next_are_counted() {
        let often = Often::default();
        assert_eq!(often.once_more(), Some(1));
        assert_eq!([often.once_more(), often.once_more()], [None, None]);
        let earlier = Instant::now().checked_sub(INTERVAL);
        often.state.lock().expect("no panic").said = earlier;
        assert_eq!(
            often.once_more(),
            Some(if earlier.is_some() { 3 } else { 4 })
        );
    }
}
