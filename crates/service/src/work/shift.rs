//! Long work that pauses: after some time it lets other addresses have their turns, then goes on. Work that all clients
//! share does not pause, since it would hold its memory meanwhile.
//!
//! The work itself is an ordinary function that checks a [`Stop`] now and then. It pauses in such a check.

use std::{
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};

use strew_core::server::Stop;

use super::{
    owner::Owner,
    turns::{Turn, Turns, Waiter},
};

/// How long work goes on while others wait.
const SHIFT: Duration = Duration::from_millis(200);

/// The hold of long work on its turn.
pub(super) struct Shift {
    turns: Turns,
    owner: Owner,
    gives_way: bool,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    /// The turn, while the work has it.
    turn: Option<Turn>,
    since: Instant,
    /// The result is no longer wanted.
    is_over: bool,
}

impl Shift {
    pub(super) fn new(turns: Turns, owner: Owner, gives_way: bool) -> Arc<Self> {
        Arc::new(Self {
            gives_way,
            turns,
            owner,
            state: Mutex::new(State {
                turn: None,
                since: Instant::now(),
                is_over: false,
            }),
            changed: Condvar::new(),
        })
    }

    /// A flag whose looks may wait.
    pub(super) fn stop(self: &Arc<Self>) -> Stop {
        let shift = self.clone();
        Stop::with_look(move || shift.look())
    }

    /// The work has a turn.
    pub(super) fn start(&self, turn: Turn) {
        let mut state = self.lock();
        (state.turn, state.since) = (Some(turn), Instant::now());
        self.changed.notify_all();
    }

    /// The result is not wanted any more, so the work does not wait for another turn. It keeps the one that it
    /// has until it notices: abandoned work must not run beside the next.
    pub(super) fn leave(&self) {
        self.lock().is_over = true;
        self.changed.notify_all();
    }

    /// The work has ended.
    pub(super) fn end(&self) {
        let mut state = self.lock();
        state.is_over = true;
        let turn = state.turn.take();
        drop(state);
        drop(turn);
    }

    /// Gives way to other addresses if the work has gone on for long.
    fn look(self: &Arc<Self>) {
        if !self.gives_way {
            return;
        }
        let mut state = self.lock();
        let address = self.owner.address();
        if state.since.elapsed() < SHIFT || !self.turns.is_wanted_by_others(address) {
            return;
        }
        let Some(turn) = state.turn.take() else {
            return;
        };
        let _waiting = self.owner.wait();
        drop(state);
        let paused = Box::new(Paused(self.clone()));
        self.turns.give_way(turn, address, paused);
        let state = self.lock();
        let waits = |state: &mut State| state.turn.is_none() && !state.is_over;
        let _state = self
            .changed
            .wait_while(state, waits)
            .unwrap_or_else(PoisonError::into_inner);
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Work that gave way.
struct Paused(Arc<Shift>);

impl Waiter for Paused {
    fn is_wanted(&self) -> bool {
        !self.0.lock().is_over
    }

    fn begin(self: Box<Self>, turn: Turn) {
        self.0.start(turn);
    }
}
