//! The hold of work on its turn: work that has had its time lets others have theirs, then goes on.
//!
//! The price of work decides its lane, and a price can be wrong. So short work that takes longer than short work may
//! gives its place up, whatever its price said: it goes on as long work, on the same thread at lower priority, when it
//! is the turn of its address. Long work gives way to other addresses after a while. What all clients share does not,
//! since it would hold its memory meanwhile. All of it is charged for the time that it took.
//!
//! The work itself is an ordinary function that checks a [`Stop`] now and then. It waits in such a check.

use std::{
    cell::RefCell,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{
        Arc, LazyLock,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

use parking_lot::{Condvar, Mutex};
use strew_core::server::Stop;
use strew_plan::Lane;

use super::{
    owner::Owner,
    turns::{Turn, Turns, Waiter},
};

/// The processor time that short work may take in all.
const SHORT: Duration = Duration::from_millis(50);
/// How long long work goes on while others wait.
const LONG: Duration = Duration::from_millis(10);
/// Work that may give way looks as often as this whether others wait, and is charged for its time.
const AGAIN: Duration = Duration::from_millis(5);

/// The niceness of threads of lower priority.
const NICENESS: i32 = 10;

thread_local! {
    static CURRENT: RefCell<Option<Arc<Shift>>> = const { RefCell::new(None) };
}

/// A flag whose looks may wait: for the work of the thread that looks, whichever that is. So what a plan was made with
/// serves the blocks that are made from it, too.
pub(super) fn stop() -> Stop {
    Stop::with_look(|| {
        CURRENT.with_borrow(|current| {
            if let Some(shift) = current {
                shift.look();
            }
        });
    })
}

/// Charges the work of this thread for its time so far: before its result is seen.
pub(super) fn charge() {
    CURRENT.with_borrow(|current| {
        if let Some(shift) = current {
            shift.charge(&mut shift.state.lock());
        }
    });
}

pub(super) struct Lanes {
    turns: [Turns; 3],
    pub(super) moved: AtomicU64,
    /// The longest processor time that short work had before it ended or became long, in nanoseconds.
    pub(super) longest: AtomicU64,
}

impl Lanes {
    /// Lanes in which this number of pieces of work has a turn at once.
    pub(super) fn new(places: impl Fn(Lane) -> usize) -> Arc<Self> {
        Arc::new(Self {
            turns: Lane::ALL.map(|lane| Turns::new(places(lane))),
            moved: AtomicU64::new(0),
            longest: AtomicU64::new(0),
        })
    }

    pub(super) const fn turns(&self, lane: Lane) -> &Turns {
        &self.turns[lane as usize]
    }
}

/// The hold of work on its turn.
pub(super) struct Shift {
    lanes: Arc<Lanes>,
    owner: Owner,
    /// When the next look may have to do something, on the clock of this process.
    due: AtomicU64,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    lane: Lane,
    /// The turn, while the work has it.
    turn: Option<Turn>,
    /// The processor time of the thread up to which the work is charged.
    charged: Duration,
    /// The same when short work began.
    begun: Duration,
    /// The result is no longer wanted.
    is_over: bool,
}

impl Shift {
    pub(super) fn new(lanes: Arc<Lanes>, owner: Owner, lane: Lane) -> Arc<Self> {
        Arc::new(Self {
            lanes,
            owner,
            due: AtomicU64::new(u64::MAX),
            state: Mutex::new(State {
                lane,
                turn: None,
                charged: Duration::ZERO,
                begun: Duration::ZERO,
                is_over: false,
            }),
            changed: Condvar::new(),
        })
    }

    pub(super) fn is_long(&self) -> bool {
        self.state.lock().lane != Lane::Short
    }

    /// The work has a turn.
    pub(super) fn take(&self, turn: Turn) {
        let mut state = self.state.lock();
        self.due_in(match state.lane {
            Lane::Short => Some(SHORT),
            Lane::Long => Some(LONG),
            Lane::Making => None,
        });
        state.turn = Some(turn);
        self.changed.notify_all();
    }

    /// Runs the work, in its turn, on the calling thread. Returns the turn that it has at the end.
    pub(super) fn run(self: &Arc<Self>, job: Box<dyn FnOnce() + Send>) -> Option<Turn> {
        {
            let mut state = self.state.lock();
            state.begun = processor_time();
            state.charged = state.begun;
        }
        CURRENT.set(Some(self.clone()));
        // The caller that waits for the result sees that there is none; the thread goes on.
        if catch_unwind(AssertUnwindSafe(job)).is_err() {
            tracing::error!("a worker panicked");
        }
        CURRENT.set(None);
        self.charge(&mut self.state.lock());
        self.end()
    }

    /// The result is not wanted any more, so the work does not wait for another turn. It keeps the one that it
    /// has until it notices: abandoned work must not run beside the next.
    pub(super) fn leave(&self) {
        self.state.lock().is_over = true;
        self.changed.notify_all();
    }

    /// There is no more work to do. Returns the turn.
    pub(super) fn end(&self) -> Option<Turn> {
        let mut state = self.state.lock();
        state.is_over = true;
        state.turn.take()
    }

    /// Lets others have their turn if the work has had its time.
    fn look(self: &Arc<Self>) {
        if now() >= self.due.load(Ordering::Relaxed) {
            self.give_way();
        }
    }

    #[cold]
    fn give_way(self: &Arc<Self>) {
        let mut state = self.state.lock();
        let address = self.owner.address();
        let long = self.lanes.turns(Lane::Long);
        self.charge(&mut state);
        if state.turn.is_none() {
            // The result is not wanted. What may still wait in the queue locks this state.
            return self.due_in(None);
        }
        match state.lane {
            Lane::Short => {
                let left = SHORT.saturating_sub(state.charged - state.begun);
                if !left.is_zero() {
                    return self.due_in(Some(left));
                }
            }
            Lane::Long if !long.is_wanted_by_others(address) => return self.due_in(Some(AGAIN)),
            Lane::Long | Lane::Making => {}
        }
        let Some(turn) = state.turn.take() else {
            return;
        };
        let was = std::mem::replace(&mut state.lane, Lane::Long);
        drop(state);
        let _waiting = self.owner.wait();
        let paused = Box::new(Paused(self.clone()));
        if was == Lane::Short {
            self.owner.is_long();
            self.lanes.moved.fetch_add(1, Ordering::Relaxed);
            lower_priority();
            long.take(address, paused);
            drop(turn);
        } else {
            long.give_way(turn, address, paused);
        }
        let waits = |state: &mut State| state.turn.is_none() && !state.is_over;
        self.changed.wait_while(&mut self.state.lock(), waits);
    }

    /// Charges the owner for the processor time since this was done last.
    fn charge(&self, state: &mut State) {
        let now = processor_time();
        if state.lane == Lane::Short {
            let time = nanoseconds(now.saturating_sub(state.begun));
            self.lanes.longest.fetch_max(time, Ordering::Relaxed);
        }
        self.owner.took(now.saturating_sub(state.charged));
        state.charged = now;
    }

    fn due_in(&self, time: Option<Duration>) {
        let due = time.map_or(u64::MAX, |time| now() + nanoseconds(time));
        self.due.store(due, Ordering::Relaxed);
    }
}

struct Paused(Arc<Shift>);

impl Waiter for Paused {
    fn is_wanted(&self) -> bool {
        !self.0.state.lock().is_over
    }

    fn begin(self: Box<Self>, turn: Turn) {
        self.0.take(turn);
    }
}

/// Lowers the priority of the calling thread for good. (On Linux a thread has a priority of its own.)
pub(super) fn lower_priority() {
    #[cfg(any(target_os = "android", target_os = "linux"))]
    let _ = rustix::process::setpriority_process(None, NICENESS);
    #[cfg(not(any(target_os = "android", target_os = "linux")))]
    let _ = NICENESS;
}

/// Nanoseconds on the clock of this process.
fn now() -> u64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    nanoseconds(START.elapsed())
}

fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX)
}

/// The processor time of the calling thread; where the system does not count it, the time on the clock.
pub(super) fn processor_time() -> Duration {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        Duration::try_from(time).unwrap_or_default()
    }
    #[cfg(not(unix))]
    Duration::from_nanos(now())
}
