//! A flag that ends counting early.

use crate::error::{Error, ErrorKind};
use alloc::sync::Arc;
use core::sync::atomic::{AtomicBool, Ordering};

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
/// ```
#[derive(Clone, Debug, Default)]
pub struct Stop {
    flag: Option<Arc<AtomicBool>>,
}

impl Stop {
    /// A flag that is never raised, as the default one.
    ///
    /// ```
    /// use strew_core::server::Stop;
    ///
    /// static NEVER: Stop = Stop::NEVER;
    /// NEVER.raise();
    /// assert!(!NEVER.is_raised());
    /// ```
    pub const NEVER: Self = Self { flag: None };

    /// A flag that is not raised and can be.
    ///
    /// ```
    /// use strew_core::server::Stop;
    ///
    /// assert!(!Stop::new().is_raised());
    /// ```
    #[must_use]
    pub fn new() -> Self {
        Self {
            flag: Some(Arc::default()),
        }
    }

    /// Raises the flag and all its clones. Does nothing to the default one.
    ///
    /// ```
    /// use strew_core::server::Stop;
    ///
    /// let (stop, never) = (Stop::new(), Stop::default());
    /// stop.raise();
    /// never.raise();
    /// assert!(stop.is_raised() && !never.is_raised());
    /// ```
    pub fn raise(&self) {
        if let Some(flag) = &self.flag {
            flag.store(true, Ordering::Relaxed);
        }
    }

    /// The error of a count that was stopped.
    pub(crate) fn error() -> Error {
        let (field, value) = ("the count", "not finished");
        Error::new(ErrorKind::Stopped, field, value, "").because("stopped")
    }

    /// Whether the flag is raised.
    ///
    /// ```
    /// use strew_core::server::Stop;
    ///
    /// let stop = Stop::new();
    /// let mut steps = 0;
    /// while !stop.is_raised() {
    ///     steps += 1;
    ///     if steps == 3 {
    ///         stop.raise();
    ///     }
    /// }
    /// assert_eq!(steps, 3);
    /// ```
    #[must_use]
    pub fn is_raised(&self) -> bool {
        self.flag
            .as_ref()
            .is_some_and(|flag| flag.load(Ordering::Relaxed))
    }
}
