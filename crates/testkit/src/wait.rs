//! Waiting for a condition. Tests never wait for a fixed time.

use std::time::{Duration, Instant};

/// The longest time that a test waits: enough for a busy machine that draws a scene without a GPU.
pub const PATIENCE: Duration = Duration::from_secs(90);

/// The pause between two looks at a condition.
const PAUSE: Duration = Duration::from_millis(5);

/// Calls `poll` until it returns a value, and returns that value.
///
/// # Panics
///
/// After [`PATIENCE`]; `what` completes the sentence "waited in vain until …".
pub fn until<T>(what: &str, mut poll: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(value) = poll() {
            return value;
        }
        assert!(start.elapsed() < PATIENCE, "waited in vain until {what}");
        std::thread::park_timeout(PAUSE);
    }
}
