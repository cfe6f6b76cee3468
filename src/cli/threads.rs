//! Threads for the work of a command.

use anyhow::Context as _;

/// This number of threads; 0 for one per core.
pub(super) fn pool(threads: usize) -> anyhow::Result<rayon::ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().context("cannot start threads")
}
