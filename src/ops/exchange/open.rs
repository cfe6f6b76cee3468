//! The open exchanges of one connection, and the fate of a connection whose client takes nothing.

use std::{
    fmt,
    sync::{
        Arc, Weak,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};

use parking_lot::Mutex;
use tokio::time::Instant;

/// An exchange whose time can be over.
pub(super) trait Timed: Send + Sync {
    /// Breaks the answer off if its time is over. Returns when it was broken off, if it was.
    fn check(&self, now: Instant) -> Option<Instant>;
}

/// The exchanges of one connection.
pub(in crate::ops) struct OpenExchanges {
    all: Mutex<Open>,
    next: AtomicU64,
}

struct Open {
    exchanges: Vec<(u64, Weak<dyn Timed>)>,
    /// When the last one began or ended.
    changed: Instant,
}

/// The fate of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ops) enum Fate {
    /// It goes on.
    GoOn,
    /// There has been no request for long, or clients left answers untouched that were broken off:
    /// it takes no more requests and ends with those that it has.
    Retire,
    /// All of its answers were broken off: it ends now.
    Close,
}

/// The time for sending the end of an answer that was broken off.
const ENDING_TIME: Duration = Duration::from_secs(1);
/// The longest time between two checks.
const LONGEST: Duration = Duration::from_secs(5);

impl fmt::Debug for OpenExchanges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OpenExchanges")
            .field("open", &self.all.lock().exchanges.len())
            .finish_non_exhaustive()
    }
}

impl OpenExchanges {
    pub(in crate::ops) fn new() -> Arc<Self> {
        Arc::new(Self {
            all: Mutex::new(Open {
                exchanges: vec![],
                changed: Instant::now(),
            }),
            next: AtomicU64::new(0),
        })
    }

    /// A place for an exchange that begins.
    pub(super) fn begin(self: &Arc<Self>) -> Entry {
        Entry {
            open: self.clone(),
            number: self.next.fetch_add(1, Ordering::Relaxed),
        }
    }

    /// Checks the exchanges from time to time. Returns when the connection should not simply go on:
    /// because of what they do, or because there is none.
    pub(in crate::ops) async fn decided(
        &self,
        idle: Duration,
        patience: Duration,
        is_closing: bool,
    ) -> Fate {
        let step = (idle.min(patience) / 4).clamp(Duration::from_millis(10), LONGEST);
        loop {
            tokio::time::sleep(step).await;
            let fate = self.fate(Instant::now(), idle, patience);
            // One that retires already can only be closed.
            if fate == Fate::Close || fate == Fate::Retire && !is_closing {
                return fate;
            }
        }
    }

    fn fate(&self, now: Instant, idle: Duration, patience: Duration) -> Fate {
        let open = self.all.lock();
        let changed = open.changed;
        let exchanges = open.exchanges.iter();
        let all: Vec<_> = exchanges.filter_map(|(_, one)| one.upgrade()).collect();
        drop(open);
        if all.is_empty() {
            let quiet = now.saturating_duration_since(changed);
            return if quiet >= idle {
                Fate::Retire
            } else {
                Fate::GoOn
            };
        }
        let broken: Vec<Instant> = all.iter().filter_map(|one| one.check(now)).collect();
        let since = |at: Option<&Instant>| at.map(|&at| now.saturating_duration_since(at));
        let newest = since(broken.iter().max());
        if broken.len() == all.len() && newest.is_some_and(|age| age >= ENDING_TIME.min(patience)) {
            return Fate::Close;
        }
        let oldest = since(broken.iter().min());
        if oldest.is_some_and(|age| age >= patience) {
            return Fate::Retire;
        }
        Fate::GoOn
    }
}

/// The place of an exchange among those of its connection, until dropped.
#[derive(Debug)]
pub(super) struct Entry {
    open: Arc<OpenExchanges>,
    number: u64,
}

impl Entry {
    /// Takes the place for an exchange.
    pub(super) fn begin(&self, exchange: Weak<dyn Timed>, now: Instant) {
        let mut open = self.open.all.lock();
        open.exchanges.push((self.number, exchange));
        open.changed = now;
    }
}

impl Drop for Entry {
    fn drop(&mut self) {
        let mut open = self.open.all.lock();
        let all = &mut open.exchanges;
        if let Some(at) = all.iter().position(|(number, _)| *number == self.number) {
            all.swap_remove(at);
        }
        open.changed = Instant::now();
    }
}
