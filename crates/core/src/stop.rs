//! A flag that ends counting early.

use crate::error::{Error, ErrorKind};
use alloc::{boxed::Box, sync::Arc};
use core::{
    fmt,
    sync::atomic::{AtomicBool, Ordering},
};

/// A flag that stops the counting of a plan. Clones share it; the default one is never raised.
///
/// Counting looks at the flag at least every few hundred lattice rows. Once it is raised the results of a
/// plan are meaningless.
///
/// ```
/// use strew_core::server::Stop;
///
/// let stop = Stop::new();
/// let shared = stop.clone();
/// std::thread::spawn(move || shared.raise()).join().expect("does not panic");
/// assert!(stop.is_raised());
/// Stop::NEVER.raise();
/// assert!(!Stop::NEVER.is_raised());
/// ```
#[derive(Clone, Default)]
pub struct Stop {
    flag: Option<Arc<Flag>>,
}

#[derive(Default)]
struct Flag {
    is_raised: AtomicBool,
    /// Called at each look.
    look: Option<Box<dyn Fn() + Send + Sync>>,
}

impl fmt::Debug for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let flag = self.flag.as_ref();
        let is_raised = flag.map(|flag| flag.is_raised.load(Ordering::Relaxed));
        f.debug_struct("Stop").field("raised", &is_raised).finish()
    }
}

impl Stop {
    /// A flag that is never raised, as the default one.
    pub const NEVER: Self = Self { flag: None };

    /// A flag that is not raised and can be.
    #[must_use]
    pub fn new() -> Self {
        Self {
            flag: Some(Arc::default()),
        }
    }

    /// A flag that calls a function at each look, before it reads the flag. Work looks often, so this is
    /// where a server lets long work wait while other work takes its turn.
    #[must_use]
    pub fn with_look(look: impl Fn() + Send + Sync + 'static) -> Self {
        let flag = Flag {
            is_raised: AtomicBool::new(false),
            look: Some(Box::new(look)),
        };
        Self {
            flag: Some(Arc::new(flag)),
        }
    }

    /// Raises the flag and all its clones. Does nothing to the default one.
    pub fn raise(&self) {
        if let Some(flag) = &self.flag {
            flag.is_raised.store(true, Ordering::Relaxed);
        }
    }

    /// The error of a count that was stopped.
    pub(crate) fn error() -> Error {
        let (field, value) = ("the count", "not finished");
        Error::new(ErrorKind::Stopped, field, value, "").because("stopped")
    }

    /// Whether the flag is raised.
    #[must_use]
    pub fn is_raised(&self) -> bool {
        self.flag.as_ref().is_some_and(|flag| {
            if let Some(look) = &flag.look {
                look();
            }
            flag.is_raised.load(Ordering::Relaxed)
        })
    }
}
