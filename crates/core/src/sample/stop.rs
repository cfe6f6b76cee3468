//! A flag that ends counting early.

use alloc::sync::Arc;
use core::sync::atomic::{AtomicBool, Ordering};

/// Tells the counting of a plan to stop. Clones share the flag; the default one is never raised.
///
/// Counting looks at the flag at least every few hundred lattice rows. Once it is raised the results of a
/// plan are meaningless.
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

    /// Raises the flag. Does nothing to the default one.
    pub fn raise(&self) {
        if let Some(flag) = &self.flag {
            flag.store(true, Ordering::Relaxed);
        }
    }

    /// Whether the flag is raised.
    #[must_use]
    pub fn is_raised(&self) -> bool {
        self.flag
            .as_ref()
            .is_some_and(|flag| flag.load(Ordering::Relaxed))
    }
}
