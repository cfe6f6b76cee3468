//! A semaphore that is fair between addresses: they take turns, and the requests of one address are
//! served in order.

use std::{
    collections::{HashMap, VecDeque},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use tokio::sync::oneshot;

/// A number of places that addresses take in turns. Cheap to clone.
#[derive(Clone, Debug)]
pub(super) struct Turns {
    state: Arc<Mutex<State>>,
}

#[derive(Debug)]
struct State {
    free: usize,
    /// Those that wait, by address. No queue is empty.
    waiting: HashMap<usize, VecDeque<oneshot::Sender<Turn>>>,
    /// The addresses that wait, the next one first.
    order: VecDeque<usize>,
}

impl State {
    /// The next waiter; its address goes to the end of the order.
    fn next(&mut self) -> Option<oneshot::Sender<Turn>> {
        loop {
            let address = self.order.pop_front()?;
            let queue = self.waiting.get_mut(&address)?;
            let next = std::iter::from_fn(|| queue.pop_front()).find(|next| !next.is_closed());
            if queue.is_empty() {
                self.waiting.remove(&address);
            } else {
                self.order.push_back(address);
            }
            if next.is_some() {
                return next;
            }
        }
    }
}

/// A place; goes to the next waiter when dropped.
#[derive(Debug)]
pub(super) struct Turn {
    /// Nothing once the place has been passed on.
    turns: Option<Turns>,
}

impl Turns {
    pub(super) fn new(places: usize) -> Self {
        let state = State {
            free: places,
            waiting: HashMap::new(),
            order: VecDeque::new(),
        };
        Self {
            state: Arc::new(Mutex::new(state)),
        }
    }

    /// Waits for a place.
    pub(super) async fn take(&self, address: usize) -> Turn {
        let waiter = {
            let mut state = self.lock();
            if state.free > 0 {
                state.free -= 1;
                return self.turn();
            }
            let (sender, waiter) = oneshot::channel();
            let queue = state.waiting.entry(address).or_default();
            // Those whose clients have left make room, lest they gather behind a long job.
            queue.retain(|waiting| !waiting.is_closed());
            let is_new = queue.is_empty();
            queue.push_back(sender);
            if is_new && !state.order.contains(&address) {
                state.order.push_back(address);
            }
            waiter
        };
        match waiter.await {
            Ok(turn) => turn,
            // The senders live as long as `self`.
            Err(_) => std::future::pending().await,
        }
    }

    fn turn(&self) -> Turn {
        Turn {
            turns: Some(self.clone()),
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        let Some(turns) = self.turns.take() else {
            return;
        };
        loop {
            let next = {
                let mut state = turns.lock();
                let next = state.next();
                if next.is_none() {
                    state.free += 1;
                }
                next
            };
            let Some(next) = next else { return };
            // A waiter that has left passes its place on.
            match next.send(turns.turn()) {
                Ok(()) => return,
                Err(mut back) => back.turns = None,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use futures_util::FutureExt as _;

    use super::*;

    #[tokio::test]
    async fn addresses_take_turns_and_those_who_left_are_passed_over() {
        let turns = Turns::new(1);
        let first = turns.take(1).await;
        let mut waiting: Vec<_> = [1, 1, 1, 2, 3]
            .map(|address| Box::pin(turns.take(address)))
            .into();
        for waiter in &mut waiting {
            assert!(waiter.now_or_never().is_none());
        }
        // The second of the first address leaves.
        drop(waiting.remove(1));
        drop(first);
        for expected in [0, 2, 3, 1] {
            let ready: Vec<_> = waiting
                .iter_mut()
                .map(|waiter| waiter.now_or_never())
                .collect();
            let at = ready.iter().position(Option::is_some);
            assert_eq!(at, Some(expected));
            // What has been taken is given back here; its future is not polled again.
            waiting[expected] = Box::pin(turns.take(99));
            drop(ready);
            if expected == 1 {
                break;
            }
        }
    }

    #[tokio::test]
    async fn a_place_is_free_again() {
        let turns = Turns::new(2);
        let held = (turns.take(1).await, turns.take(1).await);
        assert!(turns.take(2).now_or_never().is_none());
        drop(held);
        assert!(turns.take(2).now_or_never().is_some());
        assert_eq!(turns.lock().free, 2);
    }
}
