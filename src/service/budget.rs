//! Bytes in flight: what requests and answers may hold in memory at once, all together.
//!
//! Who holds something says so before, with what it will be at most; it is given back with what held
//! it. So a thousand small things and ten large ones are bounded by the same number.

use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering},
};

use super::Error;

/// What may be held, and what is.
#[derive(Debug)]
pub struct Budget {
    held: AtomicUsize,
    limit: usize,
}

impl Budget {
    /// Nothing is held, and at most `limit` bytes may be.
    #[must_use]
    pub const fn new(limit: usize) -> Self {
        Self {
            held: AtomicUsize::new(0),
            limit,
        }
    }

    /// The bytes that are held.
    #[must_use]
    pub fn held(&self) -> usize {
        self.held.load(Ordering::Acquire)
    }

    /// The right to hold so many bytes.
    ///
    /// # Errors
    /// [`Error::TooManyBytes`] if there is no room.
    pub fn hold(self: &Arc<Self>, bytes: usize) -> Result<Held, Error> {
        let mut held = Held {
            budget: self.clone(),
            bytes: 0,
        };
        held.more(bytes)?;
        Ok(held)
    }
}

/// The right to hold bytes; given back when dropped.
#[derive(Debug)]
pub struct Held {
    budget: Arc<Budget>,
    bytes: usize,
}

impl Held {
    /// The right to so many more.
    ///
    /// # Errors
    /// [`Error::TooManyBytes`] if there is no room; what was held before still is.
    pub fn more(&mut self, bytes: usize) -> Result<(), Error> {
        let limit = self.budget.limit;
        let grown = |held: usize| held.checked_add(bytes).filter(|&sum| sum <= limit);
        let held = &self.budget.held;
        held.fetch_update(Ordering::AcqRel, Ordering::Acquire, grown)
            .map_err(|_| Error::TooManyBytes { limit })?;
        self.bytes += bytes;
        Ok(())
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        self.budget.held.fetch_sub(self.bytes, Ordering::AcqRel);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_held_is_bounded_and_given_back() {
        let budget = Arc::new(Budget::new(100));
        let mut first = budget.hold(60).expect("room");
        assert_eq!(
            budget.hold(41).expect_err("no room").kind(),
            crate::service::Kind::Busy
        );
        let second = budget.hold(40).expect("room");
        assert!(first.more(1).is_err() && first.more(usize::MAX).is_err());
        drop(second);
        first.more(40).expect("room again");
        assert_eq!(budget.held(), 100);
        drop(first);
        assert_eq!(budget.held(), 0);
    }
}
