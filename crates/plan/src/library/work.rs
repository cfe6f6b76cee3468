//! The work of a call to the library.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use strew_core::server::Stop;
use strew_error::Error;

/// The work of a call, which other threads may stop and follow.
#[derive(Clone, Debug, Default)]
pub struct Work {
    /// Once it is raised, the call ends early with an error.
    pub stop: Stop,
    /// The number of points made so far.
    pub points: Arc<AtomicU64>,
}

impl Work {
    /// Work that can be stopped.
    #[must_use]
    pub fn new() -> Self {
        let stop = Stop::new();
        Self {
            stop,
            ..Self::default()
        }
    }

    /// Adds points that were made. Returns whether to make more.
    pub fn goes_on(&self, points: usize) -> bool {
        self.points.fetch_add(points as u64, Ordering::Relaxed);
        !self.stop.is_raised()
    }

    pub(super) fn finished<T>(&self, made: T) -> Result<T, Error> {
        match self.stop.is_raised() {
            true => Err(Error::Internal("the work was stopped")),
            false => Ok(made),
        }
    }
}
