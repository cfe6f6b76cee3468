//! The threads that make points.
//!
//! All numeric work runs here, never on a thread that serves sockets, in one of two lanes. Blocks and
//! short plans take well under a millisecond to a few, so many requests share few threads. Long work
//! (counts of seconds, large bodies, portraits) has threads of its own, half as many and of lower
//! priority, so that short work always finds a free thread. In both lanes addresses take turns.

use std::{fmt, sync::Arc};

use strew_core::server::Stop;

use super::{
    Error, Lane, Record,
    turns::{Turn, Turns},
};

/// The two lanes. Cheap to clone.
#[derive(Clone)]
pub struct Workers {
    short: Arc<rayon::ThreadPool>,
    long: Arc<rayon::ThreadPool>,
    /// Who may begin work, by lane.
    turns: [Turns; 2],
}

impl fmt::Debug for Workers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Workers")
            .field("short", &self.short.current_num_threads())
            .field("long", &self.long.current_num_threads())
            .finish()
    }
}

/// The niceness of the threads for long work.
const NICENESS: i32 = 10;

impl Workers {
    /// Starts this many threads for short work, 0 for one per core, and half as many for long work.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn new(threads: usize) -> Result<Self, rayon::ThreadPoolBuildError> {
        let short = pool(threads, "worker").build()?;
        let threads = short.current_num_threads();
        let long = pool((threads / 2).max(1), "long")
            .start_handler(|_| give_way())
            .build()?;
        Ok(Self {
            turns: [Turns::new(threads), Turns::new(long.current_num_threads())],
            short: Arc::new(short),
            long: Arc::new(long),
        })
    }

    /// Runs a job as soon as a thread is free.
    pub fn spawn(&self, lane: Lane, job: impl FnOnce() + Send + 'static) {
        match lane {
            Lane::Short => self.short.spawn(job),
            Lane::Long => self.long.spawn(job),
        }
    }

    /// Runs a job when it is the turn of the client's address, and waits for its result. The job
    /// should stop when the flag is raised: then the result is not wanted any more.
    ///
    /// # Errors
    /// [`Error::Internal`] if the job panicked.
    pub async fn take_turn<T: Send + 'static>(
        &self,
        lane: Lane,
        job: impl FnOnce(&Stop) -> T + Send + 'static,
    ) -> Result<T, Error> {
        let address = Record::current().map_or(0, |record| record.budget().address());
        let turn = self.turns[lane as usize].take(address).await;
        let stop = Stop::new();
        let waiting = Waiting(Some(stop.clone()));
        let answer = self.start(lane, Some(turn), move || job(&stop)).await;
        waiting.over();
        answer
    }

    /// Runs a short job at once and waits for its result.
    ///
    /// # Errors
    /// [`Error::Internal`] if the job panicked.
    pub async fn run<T: Send + 'static>(
        &self,
        job: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, Error> {
        self.start(Lane::Short, None, job).await
    }

    /// The place is held until the job has ended, whether anyone waits for it or not.
    async fn start<T: Send + 'static>(
        &self,
        lane: Lane,
        turn: Option<Turn>,
        job: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, Error> {
        let (answer, answered) = tokio::sync::oneshot::channel();
        self.spawn(lane, move || {
            let _turn = turn;
            if !answer.is_closed() {
                let _ = answer.send(job());
            }
        });
        answered
            .await
            .map_err(|_| Error::Internal("a computation failed"))
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
fn give_way() {
    #[cfg(any(target_os = "android", target_os = "linux"))]
    let _ = rustix::process::setpriority_process(None, NICENESS);
}

/// Raises a flag if it is dropped before the wait is over.
struct Waiting(Option<Stop>);

impl Waiting {
    /// Disarms the flag: the result is there, and may be used on.
    fn over(mut self) {
        self.0 = None;
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some(stop) = &self.0 {
            stop.raise();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;

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
            assert_eq!(workers.run(|| 8).await, Ok(8));
        }
        drop(end);
        assert_eq!(long.await.expect("no panic"), Ok(true));
    }
}
