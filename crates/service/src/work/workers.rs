//! The threads of each lane.

use std::{
    fmt,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use strew_core::server::Stop;
use strew_error::Error;
use strew_plan::Lane;
use tokio::sync::oneshot;

use super::{
    Owner,
    owner::Waiting,
    shift::Shift,
    turns::{Turn, Turns, Waiter},
};

/// The lanes. Cheap to clone.
#[derive(Clone)]
pub struct Workers {
    short: Arc<rayon::ThreadPool>,
    /// For what of long work is short: blocks. Whole long jobs have a thread each, since they may pause.
    long: Arc<rayon::ThreadPool>,
    /// Threads of jobs that have ended, for the next ones.
    idle: Arc<Idle>,
    /// The turns of each lane.
    turns: [Turns; 3],
}

/// Pools of one thread each, in which jobs stay.
type Idle = Mutex<Vec<Arc<rayon::ThreadPool>>>;

/// The most threads that are kept for further jobs.
const MOST_IDLE: usize = 4;

impl fmt::Debug for Workers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Workers")
            .field("short", &self.short.current_num_threads())
            .field("long", &self.long.current_num_threads())
            .finish()
    }
}

/// The niceness of the threads for all but short work.
const NICENESS: i32 = 10;

impl Workers {
    /// Starts this number of threads for short work, 0 for one per core, and half of it for long work.
    ///
    /// # Errors
    /// If the system cannot start threads.
    pub fn new(threads: usize) -> Result<Self, rayon::ThreadPoolBuildError> {
        let short = pool(threads, "worker").build()?;
        let threads = short.current_num_threads();
        let long = pool((threads / 2).max(1), "long")
            .start_handler(|_| lower_priority())
            .build()?;
        Ok(Self {
            turns: Lane::ALL.map(|lane| {
                Turns::new(match lane {
                    Lane::Short => threads,
                    Lane::Long => long.current_num_threads(),
                    Lane::Making => 1,
                })
            }),
            idle: Arc::default(),
            short: Arc::new(short),
            long: Arc::new(long),
        })
    }

    /// Runs a job when it is the turn of its owner's address, and waits for its result. The job
    /// should stop when the flag is raised: then the result is not wanted any more.
    ///
    /// # Errors
    /// [`Error::Internal`] if the job panicked.
    pub async fn take_turn<T: Send + 'static>(
        &self,
        lane: Lane,
        job: impl FnOnce(&Stop) -> T + Send + 'static,
    ) -> Result<T, Error> {
        self.take_turn_for(&Owner::current(), lane, job).await
    }

    /// [`take_turn`](Self::take_turn) for a request that is not the one being answered.
    ///
    /// # Errors
    /// As `take_turn`.
    pub async fn take_turn_for<T: Send + 'static>(
        &self,
        owner: &Owner,
        lane: Lane,
        job: impl FnOnce(&Stop) -> T + Send + 'static,
    ) -> Result<T, Error> {
        let (answer, answered) = oneshot::channel();
        let shift = (lane != Lane::Short).then(|| {
            Shift::new(
                self.turns[lane as usize].clone(),
                owner.clone(),
                lane == Lane::Long,
            )
        });
        let stop = shift.as_ref().map_or_else(Stop::new, Shift::stop);
        let wanted = Wanted(Some((stop.clone(), shift.clone())));
        let job = Job {
            waiting: owner.wait(),
            short: self.short.clone(),
            idle: self.idle.clone(),
            shift,
            answer,
            job: move || job(&stop),
        };
        self.turns[lane as usize].take(owner.address(), Box::new(job));
        let answer = answered.await;
        wanted.over();
        answer.map_err(|_| Error::Internal("a computation failed"))
    }

    /// Runs a piece of work of some milliseconds when it is the turn of its owner's address.
    pub(crate) fn take_piece(
        &self,
        owner: &Owner,
        lane: Lane,
        piece: impl FnOnce() + Send + 'static,
    ) {
        let pool = match lane {
            Lane::Short => &self.short,
            Lane::Long | Lane::Making => &self.long,
        };
        let piece = Piece {
            pool: pool.clone(),
            piece,
        };
        self.turns[lane as usize].take(owner.address(), Box::new(piece));
    }
}

fn pool(threads: usize, name: &'static str) -> rayon::ThreadPoolBuilder {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(move |i| format!("strew-{name}-{i}"))
        // A job that panics drops its answer, which its owner notices; the thread goes on.
        .panic_handler(|_| tracing::error!("a worker panicked"))
}

/// Lowers the priority of the calling thread. (On Linux a thread has a priority of its own.)
fn lower_priority() {
    #[cfg(any(target_os = "android", target_os = "linux"))]
    let _ = rustix::process::setpriority_process(None, NICENESS);
    #[cfg(not(any(target_os = "android", target_os = "linux")))]
    let _ = NICENESS;
}

/// Stops a job if it is dropped before its result arrives.
struct Wanted(Option<(Stop, Option<Arc<Shift>>)>);

impl Wanted {
    /// The result is there, and may look at the flag later.
    fn over(mut self) {
        self.0 = None;
    }
}

impl Drop for Wanted {
    fn drop(&mut self) {
        let Some((stop, shift)) = &self.0 else { return };
        stop.raise();
        if let Some(shift) = shift {
            shift.leave();
        }
    }
}

/// A job that waits for its turn.
struct Job<T, F> {
    waiting: Waiting,
    short: Arc<rayon::ThreadPool>,
    idle: Arc<Idle>,
    /// The hold on the job's turn, unless the job is short.
    shift: Option<Arc<Shift>>,
    answer: oneshot::Sender<T>,
    job: F,
}

impl<T: Send + 'static, F: FnOnce() -> T + Send + 'static> Waiter for Job<T, F> {
    fn is_wanted(&self) -> bool {
        !self.answer.is_closed()
    }

    fn begin(self: Box<Self>, turn: Turn) {
        let Self {
            waiting,
            short,
            idle,
            shift,
            answer,
            job,
        } = *self;
        drop(waiting);
        let Some(shift) = shift else {
            return short.spawn(move || {
                let _turn = turn;
                if !answer.is_closed() {
                    let _ = answer.send(job());
                }
            });
        };
        // A thread of its own, which may pause, in a pool of its own, where it stays.
        let start = || pool(1, "job").start_handler(|_| lower_priority()).build();
        let free = lock(&idle).pop();
        let thread = match free.map_or_else(|| start().map(Arc::new), Ok) {
            Ok(thread) => thread,
            Err(error) => return tracing::error!(%error, "no thread for long work"),
        };
        let own = thread.clone();
        thread.spawn(move || {
            let _end = EndOnDrop(shift.clone());
            shift.start(turn);
            if !answer.is_closed() {
                let _ = answer.send(job());
            }
            let mut idle = lock(&idle);
            if idle.len() < MOST_IDLE {
                idle.push(own);
            }
        });
    }
}

fn lock(idle: &Idle) -> MutexGuard<'_, Vec<Arc<rayon::ThreadPool>>> {
    idle.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends a shift, also when its job panics.
struct EndOnDrop(Arc<Shift>);

impl Drop for EndOnDrop {
    fn drop(&mut self) {
        self.0.end();
    }
}

/// A piece of work that waits for its turn.
struct Piece<F> {
    pool: Arc<rayon::ThreadPool>,
    piece: F,
}

impl<F: FnOnce() + Send + 'static> Waiter for Piece<F> {
    fn is_wanted(&self) -> bool {
        true
    }

    fn begin(self: Box<Self>, turn: Turn) {
        let piece = self.piece;
        self.pool.spawn(move || {
            let _turn = turn;
            piece();
        });
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;
    use crate::{Budget, Record};
    use strew_access::Usage;

    /// The owner of an address of its own.
    fn record() -> Arc<Record> {
        Record::new(
            "r",
            None,
            Budget::new(1 << 20).of_address(Usage::unlimited()),
        )
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn long_work_leaves_short_work_its_threads() {
        let workers = Workers::new(1).expect("threads");
        let (end, held) = mpsc::channel::<()>();
        let long = workers.clone();
        let long = tokio::spawn(async move {
            long.take_turn(Lane::Long, move |_| held.recv().is_err())
                .await
        });
        for _ in 0..10 {
            let short = workers.take_turn(Lane::Short, |_| 7).await;
            assert_eq!(short, Ok(7));
        }
        drop(end);
        assert_eq!(long.await.expect("no panic"), Ok(true));
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn long_work_gives_way_to_other_addresses_and_goes_on_then() {
        let workers = Workers::new(1).expect("threads");
        let (begun, has_begun) = mpsc::channel();
        let (end, is_over) = mpsc::channel::<()>();
        let endless = {
            let (workers, record) = (workers.clone(), record());
            tokio::spawn(record.scope(async move {
                let job = move |stop: &Stop| {
                    begun.send(()).expect("the test listens");
                    while is_over.try_recv() == Err(mpsc::TryRecvError::Empty) {
                        assert!(!stop.is_raised());
                    }
                };
                workers.take_turn(Lane::Long, job).await
            }))
        };
        has_begun.recv().expect("it begins");
        // The only place is taken by work that ends after this.
        let other = record().scope(workers.take_turn(Lane::Long, |_| 7)).await;
        assert_eq!(other, Ok(7));
        drop(end);
        assert_eq!(endless.await.expect("no panic"), Ok(()));
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn work_that_is_not_wanted_ends_also_while_it_waits() {
        let workers = Workers::new(1).expect("threads");
        let (begun, has_begun) = mpsc::channel();
        let (ended, has_ended) = mpsc::channel();
        let job = move |stop: &Stop| {
            begun.send(()).expect("the test listens");
            while !stop.is_raised() {}
            ended.send(()).expect("the test listens");
        };
        let left = {
            let workers = workers.clone();
            tokio::spawn(record().scope(async move { workers.take_turn(Lane::Long, job).await }))
        };
        has_begun.recv().expect("it begins");
        left.abort();
        has_ended.recv().expect("it ends");
        assert_eq!(workers.take_turn(Lane::Long, |_| 8).await, Ok(8));
    }
}
