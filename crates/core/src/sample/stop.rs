//! A flag that ends counting before it is done: whoever waited for a plan may be gone.

use alloc::sync::Arc;
use core::sync::atomic::{AtomicBool, Ordering};

/// Tells the counting of a plan to stop. Clones share the flag; the default is never raised.
///
/// It is looked at every few hundred lattice rows at most. What a plan gives once it is up means
/// nothing.
#[derive(Clone, Debug, Default)]
pub struct Stop {
    flag: Option<Arc<AtomicBool>>,
}

impl Stop {
    /// A flag that can be raised.
    #[must_use]
    pub fn new() -> Self {
        Self {
            flag: Some(Arc::default()),
        }
    }

    /// From now on: stop. Does nothing to the default.
    pub fn raise(&self) {
        if let Some(flag) = &self.flag {
            flag.store(true, Ordering::Relaxed);
        }
    }

    /// Whether to stop.
    #[must_use]
    pub fn is_raised(&self) -> bool {
        self.flag
            .as_ref()
            .is_some_and(|flag| flag.load(Ordering::Relaxed))
    }
}
