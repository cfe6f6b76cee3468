//! Waiting for a condition. Tests never wait for a fixed time.

use std::time::{Duration, Instant};

/// The longest time that a test waits: enough for a busy machine that draws a scene without a GPU.
pub const PATIENCE: Duration = Duration::from_secs(90);

/// The pause between two looks at a condition.
const PAUSE: Duration = Duration::from_millis(5);

/// What a look returns: whether a condition holds, or the value that was waited for.
pub trait Look<T> {
    fn found(self) -> Option<T>;
}

impl<T> Look<T> for Option<T> {
    fn found(self) -> Self {
        self
    }
}

impl Look<()> for bool {
    fn found(self) -> Option<()> {
        self.then_some(())
    }
}

/// Looks until a condition holds, or until there is a value, and returns that value.
///
/// # Panics
///
/// After [`PATIENCE`]; `what` completes the sentence "waited in vain until …".
pub fn until<T, L: Look<T>>(what: &str, mut look: impl FnMut() -> L) -> T {
    let start = Instant::now();
    loop {
        if let Some(value) = look().found() {
            return value;
        }
        assert!(start.elapsed() < PATIENCE, "waited in vain until {what}");
        std::thread::park_timeout(PAUSE);
    }
}
