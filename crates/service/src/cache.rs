//! Samplers ready to answer, by the digest of their table: a table that replaces another never gets
//! the other's sampler.
//!
//! The cache is bounded by the memory of its samplers. A sampler is built once, on the workers, however many queries
//! wait for it.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use arc_swap::ArcSwapOption;
use moka::{future::Cache, policy::EvictionPolicy};
use strew_catalog::{Entry, Ready};
use strew_error::Error;
use strew_plan::Lane;

use crate::Workers;

#[derive(Clone)]
pub(super) struct Samplers {
    ready: Cache<String, Ready>,
    /// The entry that was found last, by its digest: found again at once, it is the youngest of the cache already.
    last: Arc<ArcSwapOption<Ready>>,
    asked: Arc<AtomicU64>,
    made: Arc<AtomicU64>,
    loaded: Arc<AtomicU64>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CacheState {
    pub hits: u64,
    pub misses: u64,
    pub loads: u64,
    /// The bytes of all entries.
    pub bytes: u64,
}

impl Samplers {
    /// An empty cache that holds at most this many bytes.
    pub(super) fn new(bytes: u64) -> Self {
        let weight = |_: &String, ready: &Ready| {
            u32::try_from(ready.table.memory_bytes()).unwrap_or(u32::MAX)
        };
        let ready = Cache::builder()
            .name("samplers")
            .max_capacity(bytes)
            // The default policy admits a new table only if it is requested more often than an old one.
            .eviction_policy(EvictionPolicy::lru())
            .weigher(weight)
            .build();
        Self {
            ready,
            last: Arc::default(),
            asked: Arc::default(),
            made: Arc::default(),
            loaded: Arc::default(),
        }
    }

    pub(super) async fn state(&self) -> CacheState {
        // The cache updates its weight only now and then.
        self.ready.run_pending_tasks().await;
        // In this order, so that there are never more misses than questions.
        let misses = self.made.load(Ordering::Relaxed);
        CacheState {
            hits: self.asked.load(Ordering::Relaxed).saturating_sub(misses),
            misses,
            loads: self.loaded.load(Ordering::Relaxed),
            bytes: self.ready.weighted_size(),
        }
    }

    pub(super) async fn get(&self, entry: &Arc<Entry>, workers: &Workers) -> Result<Ready, Error> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        if let Some(last) = &*self.last.load()
            && last.entry.digest == entry.digest
        {
            return Ok(Ready::clone(last));
        }
        if let Some(ready) = self.ready.get(&entry.digest).await {
            self.last.store(Some(Arc::new(ready.clone())));
            return Ok(ready);
        }
        let build = async {
            self.made.fetch_add(1, Ordering::Relaxed);
            let entry = entry.clone();
            if entry.is_on_disk() {
                self.loaded.fetch_add(1, Ordering::Relaxed);
                // Waits for the disk, so not on the few threads that make points.
                let load = tokio::task::spawn_blocking(move || Ready::load(&entry));
                return load
                    .await
                    .unwrap_or(Err(Error::Internal("a computation failed")));
            }
            workers
                .take_turn(Lane::Short, move |_| Ready::load(&entry))
                .await?
        };
        // On the heap, lest those that find their table have room for it.
        let made = Box::pin(self.ready.try_get_with_by_ref(&entry.digest, build));
        made.await.map_err(|error| (*error).clone())
    }

    /// The entry of a name, if the cache has one.
    pub(super) async fn known(&self, name: &str) -> Option<Ready> {
        self.ready.get(name).await
    }

    /// Keeps something under a name that is no digest.
    pub(super) async fn keep(&self, name: String, ready: Ready) {
        self.ready.insert(name, ready).await;
    }

    /// Makes room: the table of this digest is not loaded any more, so neither it nor its mixes, whose names begin
    /// with the digest, are wanted. Answers under way keep what they have.
    pub(super) async fn forget(&self, digest: &str) {
        let names = self.ready.iter().map(|(name, _)| name);
        let names: Vec<_> = names.filter(|name| name.starts_with(digest)).collect();
        for name in names {
            self.ready.invalidate(&*name).await;
        }
        self.last.store(None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strew_catalog::Catalog;

    fn catalog() -> (tempfile::TempDir, Catalog) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for alpha in ["sqrt(3)", "3/2"] {
            let alpha = alpha.parse().expect("valid");
            let table = strew_core::Table::undisplaced(alpha, 20, "pattern").expect("small");
            let name = format!("{}.strew", &table.digest().to_string()[..8]);
            std::fs::write(folder.path().join(name), table.to_bytes()).expect("writable");
        }
        let catalog = Catalog::load(false, Some(folder.path())).expect("valid");
        (folder, catalog)
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn many_ask_one_builds() {
        let (_folder, catalog) = catalog();
        let entry = catalog.entries().next().expect("two").clone();
        let workers = Workers::new(2);
        let samplers = Samplers::new(1 << 20);
        let asked = (0..50).map(|_| samplers.get(&entry, &workers));
        let got = futures_util::future::join_all(asked).await;
        let vectors = |ready: &Result<Ready, Error>| {
            let ready = ready.as_ref().expect("built");
            ready.table.displacements().as_ptr()
        };
        assert!(got.iter().all(|ready| vectors(ready) == vectors(&got[0])));
    }

    #[tokio::test]
    async fn a_table_that_is_gone_takes_its_mixes_along() {
        let (_folder, catalog) = catalog();
        let workers = Workers::new(1);
        let samplers = Samplers::new(1 << 30);
        for entry in catalog.entries() {
            let ready = samplers.get(entry, &workers).await.expect("built");
            samplers.keep(format!("{}-1-3", entry.digest), ready).await;
        }
        let mut entries = catalog.entries();
        let (gone, stays) = (entries.next().expect("two"), entries.next().expect("two"));
        samplers.forget(&gone.digest).await;
        for (entry, is_there) in [(gone, false), (stays, true)] {
            for name in [entry.digest.clone(), format!("{}-1-3", entry.digest)] {
                assert_eq!(samplers.known(&name).await.is_some(), is_there, "{name}");
            }
        }
    }

    #[tokio::test]
    async fn what_does_not_fit_is_answered_all_the_same_and_not_kept() {
        let (_folder, catalog) = catalog();
        let workers = Workers::new(1);
        let samplers = Samplers::new(100);
        for entry in catalog.entries() {
            samplers.get(entry, &workers).await.expect("built");
        }
        samplers.ready.run_pending_tasks().await;
        assert_eq!(samplers.ready.weighted_size(), 0);
    }
}
