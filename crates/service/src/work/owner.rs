//! The owner of work: the request that it is done for.
//!
//! The work takes turns with that of other addresses, and the request's clock stands still while it waits for one.

use std::{sync::Arc, time::Duration};

use strew_plan::Lane;

use crate::{Budget, Record};

#[derive(Clone, Debug)]
pub struct Owner(Option<Arc<Record>>);

impl Owner {
    /// The request that is being answered; outside of all requests the daemon itself.
    pub fn current() -> Self {
        Self(Record::current())
    }

    pub(super) fn address(&self) -> usize {
        let budget = self.0.as_ref().map(|record| record.budget());
        budget.map_or(0, Budget::address)
    }

    pub(crate) fn is_of(&self, other: &Self) -> bool {
        self.address() == other.address()
    }

    pub(crate) async fn scope<F: Future>(self, future: F) -> F::Output {
        match self.0 {
            Some(record) => record.scope(future).await,
            None => future.await,
        }
    }

    pub(super) fn took(&self, time: Duration) {
        if let Some(record) = &self.0 {
            record.took(time);
        }
    }

    /// What the request needs further is long work.
    pub(super) fn is_long(&self) {
        if let Some(record) = &self.0 {
            record.take_lane(Lane::Long);
        }
    }

    pub(crate) fn lane(&self) -> Lane {
        self.0.as_ref().map_or(Lane::Short, |record| record.lane())
    }

    /// Waits for a turn until the guard is dropped.
    pub(super) fn wait(&self) -> Waiting {
        if let Some(record) = &self.0 {
            record.clock().wait();
        }
        Waiting(self.clone())
    }
}

/// Work that waits for its turn, until this is dropped.
#[derive(Debug)]
pub(super) struct Waiting(Owner);

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some(record) = &self.0.0 {
            record.clock().go_on();
        }
    }
}
