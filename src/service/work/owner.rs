//! Whose work something is: the request that it is done for.
//!
//! The address of the request takes its turns by it, and its clock stands still while it waits for one.

use std::sync::Arc;

use super::clock::Waiting;
use crate::service::{Budget, Record};

/// The request that work is done for. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Owner(Option<Arc<Record>>);

impl Owner {
    /// The request that is being answered; outside of all requests the daemon itself.
    #[must_use]
    pub fn current() -> Self {
        Self(Record::current())
    }

    /// A number that tells addresses apart.
    pub(super) fn address(&self) -> usize {
        let budget = self.0.as_ref().map(|record| record.budget());
        budget.map_or(0, Budget::address)
    }

    /// Whether both are requests of one address.
    pub(in crate::service) fn is_of(&self, other: &Self) -> bool {
        self.address() == other.address()
    }

    /// Runs a future as a part of the request.
    pub(in crate::service) async fn scope<F: Future>(self, future: F) -> F::Output {
        match self.0 {
            Some(record) => record.scope(future).await,
            None => future.await,
        }
    }

    /// Waits for a turn until the guard is dropped.
    pub(super) fn wait(&self) -> Waiting {
        Waiting::of(self.0.as_ref().map(|record| record.clock().clone()))
    }
}
