//! A semaphore that is fair between addresses: they take turns, and the work of one address is done in order.

use std::{
    collections::{HashMap, VecDeque},
    sync::Arc,
};

use parking_lot::Mutex;

pub(super) trait Waiter: Send {
    fn is_wanted(&self) -> bool;
    /// Begins, or goes on, elsewhere: must return at once.
    fn begin(self: Box<Self>, turn: Turn);
}

/// A number of places that addresses take in turns. Cheap to clone.
#[derive(Clone)]
pub(super) struct Turns(Arc<Mutex<State>>);

struct State {
    free: usize,
    /// The waiting work, by address. No queue is empty.
    waiting: HashMap<usize, VecDeque<Box<dyn Waiter>>>,
    /// The addresses that wait, the next one first.
    order: VecDeque<usize>,
}

impl State {
    /// The next waiter; its address goes to the end of the order.
    fn next(&mut self) -> Option<Box<dyn Waiter>> {
        loop {
            let address = self.order.pop_front()?;
            let queue = self.waiting.get_mut(&address)?;
            let next = std::iter::from_fn(|| queue.pop_front()).find(|next| next.is_wanted());
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
pub(super) struct Turn(Turns);

impl Turns {
    pub(super) fn new(places: usize) -> Self {
        let state = State {
            free: places,
            waiting: HashMap::new(),
            order: VecDeque::new(),
        };
        Self(Arc::new(Mutex::new(state)))
    }

    /// Begins work of an address as soon as it has a place, after all other work of the address.
    pub(super) fn take(&self, address: usize, waiter: Box<dyn Waiter>) {
        let mut state = self.0.lock();
        if state.free > 0 {
            state.free -= 1;
            drop(state);
            return waiter.begin(Turn(self.clone()));
        }
        let queue = state.waiting.entry(address).or_default();
        // Waiters whose clients have left make room, lest they gather behind a long job.
        queue.retain(|waiting| waiting.is_wanted());
        queue.push_back(waiter);
        if !state.order.contains(&address) {
            state.order.push_back(address);
        }
    }

    /// Gives a place to others, and goes on when it is the turn of the address again: after all other addresses,
    /// before all other work of its own.
    pub(super) fn give_way(&self, turn: Turn, address: usize, waiter: Box<dyn Waiter>) {
        let mut state = self.0.lock();
        let queue = state.waiting.entry(address).or_default();
        queue.push_front(waiter);
        state.order.retain(|&other| other != address);
        state.order.push_back(address);
        drop(state);
        drop(turn);
    }

    pub(super) fn is_wanted_by_others(&self, address: usize) -> bool {
        self.0.lock().order.iter().any(|&other| other != address)
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        let next = {
            let mut state = self.0.0.lock();
            let next = state.next();
            if next.is_none() {
                state.free += 1;
            }
            next
        };
        if let Some(next) = next {
            next.begin(Self(self.0.clone()));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{
        atomic::{AtomicBool, Ordering},
        mpsc::{Receiver, Sender, channel},
    };

    use super::*;

    struct Named {
        name: u32,
        begun: Sender<(u32, Turn)>,
        is_wanted: Arc<AtomicBool>,
    }

    impl Waiter for Named {
        fn is_wanted(&self) -> bool {
            self.is_wanted.load(Ordering::Relaxed)
        }

        fn begin(self: Box<Self>, turn: Turn) {
            self.begun.send((self.name, turn)).expect("a test listens");
        }
    }

    struct Scene {
        turns: Turns,
        sender: Sender<(u32, Turn)>,
        begun: Receiver<(u32, Turn)>,
    }

    impl Scene {
        fn new(places: usize) -> Self {
            let (sender, begun) = channel();
            Self {
                turns: Turns::new(places),
                sender,
                begun,
            }
        }

        fn named(&self, name: u32) -> (Box<Named>, Arc<AtomicBool>) {
            let is_wanted = Arc::new(AtomicBool::new(true));
            let named = Named {
                name,
                begun: self.sender.clone(),
                is_wanted: is_wanted.clone(),
            };
            (Box::new(named), is_wanted)
        }

        fn take(&self, address: usize, name: u32) -> Arc<AtomicBool> {
            let (named, is_wanted) = self.named(name);
            self.turns.take(address, named);
            is_wanted
        }

        fn next(&self) -> Option<(u32, Turn)> {
            self.begun.try_recv().ok()
        }
    }

    #[test]
    fn addresses_take_turns_and_those_who_left_are_passed_over() {
        let scene = Scene::new(1);
        scene.take(1, 0);
        let (_, mut turn) = scene.next().expect("a free place");
        let wanted: Vec<_> = [(1, 10), (1, 11), (1, 12), (2, 20), (3, 30)]
            .map(|(address, name)| scene.take(address, name))
            .into();
        assert!(scene.next().is_none());
        wanted[1].store(false, Ordering::Relaxed);
        for expected in [10, 20, 30, 12] {
            drop(turn);
            let (name, next) = scene.next().expect("a place that was passed on");
            assert_eq!(name, expected);
            assert!(scene.next().is_none());
            turn = next;
        }
        drop(turn);
        assert_eq!(scene.turns.0.lock().free, 1);
    }

    #[test]
    fn work_that_gave_way_goes_on_before_its_address_begins_more() {
        let scene = Scene::new(1);
        scene.take(1, 10);
        let (_, turn) = scene.next().expect("a free place");
        scene.take(1, 11);
        assert!(!scene.turns.is_wanted_by_others(1));
        scene.take(2, 20);
        assert!(scene.turns.is_wanted_by_others(1));
        scene.turns.give_way(turn, 1, scene.named(10).0);
        let mut names = vec![];
        while let Some((name, _turn)) = scene.next() {
            names.push(name);
        }
        assert_eq!(names, [20, 10, 11]);
    }
}
