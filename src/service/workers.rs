//! The threads that make points.
//!
//! All numeric work runs here, never on a thread that serves sockets. A job makes one block or one
//! plan and is over in well under a millisecond, so many streams share few threads fairly.

use std::{fmt, sync::Arc};

use strew_core::server::Stop;

use super::Error;

/// A handle of the pool.
#[derive(Clone)]
pub struct Workers {
    pool: Arc<rayon::ThreadPool>,
}

impl fmt::Debug for Workers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Workers")
            .field("threads", &self.pool.current_num_threads())
            .finish()
    }
}

impl Workers {
    /// Starts this many threads; 0 for one per core.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn new(threads: usize) -> Result<Self, rayon::ThreadPoolBuildError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("strew-worker-{i}"))
            // A job that panics drops its answer, which its owner notices; the thread goes on.
            .panic_handler(|_| tracing::error!("a worker panicked"))
            .build()?;
        Ok(Self {
            pool: Arc::new(pool),
        })
    }

    /// Runs a job some time soon.
    pub fn spawn(&self, job: impl FnOnce() + Send + 'static) {
        self.pool.spawn(job);
    }

    /// Runs a job that stops early when nobody waits for it any more.
    ///
    /// # Errors
    /// [`Error::Internal`] if the job panicked.
    pub async fn run_while_wanted<T: Send + 'static>(
        &self,
        job: impl FnOnce(&Stop) -> T + Send + 'static,
    ) -> Result<T, Error> {
        let stop = Stop::new();
        let waiting = Waiting(Some(stop.clone()));
        let answer = self.run(move || job(&stop)).await;
        waiting.over();
        answer
    }

    /// Runs a job and waits for what it gives.
    ///
    /// # Errors
    /// [`Error::Internal`] if the job panicked.
    pub async fn run<T: Send + 'static>(
        &self,
        job: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, Error> {
        let (answer, answered) = tokio::sync::oneshot::channel();
        self.spawn(move || {
            if !answer.is_closed() {
                let _ = answer.send(job());
            }
        });
        answered
            .await
            .map_err(|_| Error::Internal("a computation failed"))
    }
}

/// Raises a flag if it is dropped before the wait is over.
struct Waiting(Option<Stop>);

impl Waiting {
    /// What was waited for is there, and may be used on.
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
