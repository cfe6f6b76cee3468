//! The byte budget: the memory that requests and answers hold at once, bounded for the daemon and for each address.
//!
//! A holder reserves the most that it can grow to, and returns it on drop. A thousand small answers and ten large ones
//! thus have the same bound.

use std::sync::Arc;

use crate::access::{Quota, Usage};
use strew_catalog::sent::Sender;
use strew_error::{Denied, Error};

/// The byte budget that a request takes from: the daemon's, and that of the client's address. Cheap
/// to clone.
#[derive(Clone, Debug)]
pub struct Budget {
    all: Arc<Quota>,
    address: Arc<Usage>,
}

impl Budget {
    /// A budget of `limit` bytes for all addresses.
    pub fn new(limit: usize) -> Self {
        Self {
            all: Arc::new(Quota::new(limit)),
            address: Usage::unlimited(),
        }
    }

    /// This budget, limited further by what one address may hold.
    pub fn of_address(&self, address: Arc<Usage>) -> Self {
        Self {
            all: self.all.clone(),
            address,
        }
    }

    pub(super) fn address(&self) -> usize {
        Arc::as_ptr(&self.address).addr()
    }

    pub(super) fn sender(&self) -> Sender {
        Sender(self.address.client())
    }

    /// The bytes that are held of all addresses together.
    pub fn held(&self) -> usize {
        self.all.used()
    }

    pub fn limit(&self) -> usize {
        self.all.limit()
    }

    /// Takes bytes.
    ///
    /// # Errors
    /// [`Error::NeedsMoreBytes`] if there can never be room, [`Error::TooManyBytes`] if there is none now,
    /// [`Denied::Address`] if the address has used its own, [`Denied::Share`] if little is left for others.
    pub fn hold(&self, bytes: usize) -> Result<Held, Error> {
        let mut held = self.hold_anyway(0);
        held.grow(bytes)?;
        Ok(held)
    }

    /// Takes bytes that exist already, whatever the limit.
    pub fn hold_anyway(&self, bytes: usize) -> Held {
        self.all.take_anyway(bytes);
        self.address.bytes.take_anyway(bytes);
        Held {
            budget: self.clone(),
            bytes,
        }
    }
}

/// A share of the budget; given back when dropped.
#[derive(Debug)]
pub struct Held {
    budget: Budget,
    bytes: usize,
}

impl Held {
    /// Takes more bytes.
    ///
    /// # Errors
    /// As [`Budget::hold`]; the bytes held before stay held.
    pub fn grow(&mut self, bytes: usize) -> Result<(), Error> {
        if bytes == 0 {
            // Also where more is held than the limit, by [`Budget::hold_anyway`].
            return Ok(());
        }
        let Budget { all, address } = &self.budget;
        for (limit, setting) in [
            (all.limit(), "limits.max_bytes_in_flight"),
            (address.bytes.limit(), "per_address.max_bytes_in_flight"),
        ] {
            let needed = self.bytes.saturating_add(bytes);
            if needed > limit {
                return Err(Error::NeedsMoreBytes {
                    needed,
                    limit,
                    setting,
                });
            }
        }
        if !address.bytes.take(bytes) {
            let (what, limit) = ("bytes", address.bytes.limit());
            return Err(Denied::Address { what, limit }.into());
        }
        let refused = if !address.bytes.is_fair(all) {
            let (what, limit) = ("bytes", all.limit());
            Some(Denied::Share { what, limit }.into())
        } else {
            (!all.take(bytes)).then(|| Error::TooManyBytes { limit: all.limit() })
        };
        if let Some(refused) = refused {
            address.bytes.give_back(bytes);
            return Err(refused);
        }
        self.bytes += bytes;
        Ok(())
    }

    /// Gives back all but `bytes`.
    pub fn shrink_to(&mut self, bytes: usize) {
        self.give_back(self.bytes.saturating_sub(bytes));
    }

    fn give_back(&mut self, bytes: usize) {
        self.budget.all.give_back(bytes);
        self.budget.address.bytes.give_back(bytes);
        self.bytes -= bytes;
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        self.give_back(self.bytes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_held_is_bounded_and_given_back() {
        let budget = Budget::new(100);
        let mut first = budget.hold(60).expect("room");
        assert_eq!(
            budget.hold(41).expect_err("no room").kind(),
            strew_error::Kind::Busy
        );
        let never = budget.hold(101).expect_err("never room");
        assert_eq!(never.retry_seconds(), None);
        assert!(
            never
                .to_string()
                .contains("limits.max_bytes_in_flight = 100")
        );
        let second = budget.hold(40).expect("room");
        assert!(first.grow(1).is_err() && first.grow(usize::MAX).is_err());
        drop(second);
        first.grow(40).expect("room again");
        assert_eq!(budget.held(), 100);
        first.shrink_to(30);
        assert_eq!(budget.held(), 30);
        let beyond = budget.hold_anyway(100);
        assert!(budget.hold(0).is_ok() && budget.hold(1).is_err());
        drop((first, beyond));
        assert_eq!(budget.held(), 0);
    }
}
