//! The number of points that a search may visit, and the number that it has visited.

use core::{cell::Cell, ops::ControlFlow};

use super::limits::MAX_CANDIDATES;
use crate::stop::Stop;

/// The number of points that a search may visit, kept or not, the number that it has visited, and a flag that ends it.
///
/// ```
/// use strew_core::server::{Stop, Visits};
///
/// let visits = Visits::new(1000, Stop::new());
/// assert_eq!(visits.made(), 0);
/// ```
#[derive(Debug)]
pub struct Visits {
    most: usize,
    made: Cell<usize>,
    stop: Stop,
}

/// Visits between two looks at the flag where each takes long.
const OFTEN: usize = 16;

impl Visits {
    /// A limit of `most` points, or of the number that any search may visit if that is smaller, until a flag is raised.
    #[must_use]
    pub fn new(most: usize, stop: Stop) -> Self {
        Self {
            most: most.min(2 * MAX_CANDIDATES),
            made: Cell::new(0),
            stop,
        }
    }

    /// The limit of any search.
    pub(crate) fn any() -> Self {
        Self::new(usize::MAX, Stop::default())
    }

    /// The points that were visited.
    #[must_use]
    pub fn made(&self) -> usize {
        self.made.get()
    }

    /// The flag.
    pub(crate) const fn stop(&self) -> &Stop {
        &self.stop
    }

    pub(crate) const fn most(&self) -> usize {
        self.most
    }

    /// Whether the flag is raised.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stop.is_raised()
    }

    /// Counts the points of a row that are visited together.
    pub(crate) fn row(&self, points: usize) -> ControlFlow<()> {
        self.made.set(self.made.get() + points);
        self.look()
    }

    /// Counts a point whose visit takes long.
    pub(super) fn one(&self) -> ControlFlow<()> {
        let made = self.made.get() + 1;
        self.made.set(made);
        match made % OFTEN {
            0 => self.look(),
            _ => ControlFlow::Continue(()),
        }
    }

    fn look(&self) -> ControlFlow<()> {
        match self.is_stopped() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}
