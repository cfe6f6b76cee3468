//! What the daemon does, without a wire: checked queries, tables, samplers, streams of blocks.
//!
//! A query comes in as raw parameters or typed fields and leaves [`query`] checked. [`Service`]
//! finds its table in the [`catalog`], takes a sampler from the [`cache`], plans the region on the
//! [`workers`] and hands out a [`stream`] of blocks that an encoder makes one at a time, on demand.
//! Encoders ([`encode`]) are plain iterators: a command line can run them without any of the rest.

pub mod cache;
pub mod catalog;
pub mod encode;
pub mod error;
mod portrait;
pub mod query;
pub mod stream;
pub mod workers;

use std::sync::Arc;

use bytes::Bytes;
use futures_util::{Stream, StreamExt as _};
use serde::{Deserialize, Serialize};
use strew_core::{Plan, Sampler};

pub use catalog::{Catalog, Entry, Key};
pub use encode::{Answer, Encoding, Output};
pub use error::{Error, Fault, Kind};
pub use portrait::Portrait;
pub use query::{Draft, Query};
pub use stream::{BlockStream, Interrupted, Permit, Streams};
pub use workers::Workers;

use cache::Samplers;
use portrait::Portraits;

/// What a query may ask for, and what answering may hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The most points of one answer. Keeps a slip of a zero from filling a disk; the refusal says
    /// the exact count.
    pub max_points: u64,
    /// The most answers under way at once. Bounds memory: an answer holds 1 to 2 MB,
    /// two blocks and the rows it is made of, and a picture up to 16 MB more.
    pub max_streams: usize,
    /// The size of a block before it is encoded, in bytes.
    pub block_bytes: usize,
    /// The most memory for samplers that are ready to answer, in bytes.
    pub cache_bytes: u64,
}

/// A checked query with its table and its plan: the exact count is known, no point is made yet.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The query.
    pub query: Query,
    /// The table that answers.
    pub entry: Arc<Entry>,
    /// The plan.
    pub plan: Plan,
}

impl Planned {
    /// Plans a query on a sampler of its table.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the box reaches farther than points can be told apart.
    pub fn new(query: Query, entry: Arc<Entry>, sampler: &Arc<Sampler>) -> Result<Self, Error> {
        let plan = sampler
            .plan(query.placement(), query.region)
            .map_err(|error| query.too_far(&error))?;
        Ok(Self { query, entry, plan })
    }

    /// Plans a query at once, in the calling thread: what a command line needs.
    ///
    /// # Errors
    /// As [`new`](Self::new), or [`Error::Internal`] if the table cannot be read any more.
    pub fn from_catalog(catalog: &Catalog, query: Query) -> Result<Self, Error> {
        let entry = catalog.entry(&query.key()).ok_or_else(Error::lost_table)?;
        let sampler = Arc::new(entry.sampler()?);
        Self::new(query, entry, &sampler)
    }

    /// How many points the answer has. Regions can hold more than 64 bits count, so this is wider
    /// than any limit.
    #[must_use]
    pub const fn count(&self) -> u128 {
        self.plan.count()
    }
}

/// Everything a front end needs. Cheap to share behind an [`Arc`].
#[derive(Debug)]
pub struct Service {
    catalog: Catalog,
    limits: Limits,
    samplers: Samplers,
    portraits: Portraits,
    streams: Arc<Streams>,
    workers: Workers,
}

impl Service {
    /// A service over a catalog.
    #[must_use]
    pub fn new(catalog: Catalog, limits: Limits, workers: Workers) -> Self {
        Self {
            samplers: Samplers::new(limits.cache_bytes),
            portraits: Portraits::new(),
            streams: Arc::new(Streams::new(limits.max_streams)),
            catalog,
            limits,
            workers,
        }
    }

    /// The tables that are loaded.
    #[must_use]
    pub const fn catalog(&self) -> &Catalog {
        &self.catalog
    }

    /// The limits.
    #[must_use]
    pub const fn limits(&self) -> &Limits {
        &self.limits
    }

    /// The threads that make points.
    #[must_use]
    pub const fn workers(&self) -> &Workers {
        &self.workers
    }

    /// The streams under way.
    #[must_use]
    pub const fn streams(&self) -> &Arc<Streams> {
        &self.streams
    }

    /// Plans a query on the workers.
    ///
    /// # Errors
    /// [`Error::TooManyPoints`] over the limit, [`Error::Invalid`] for a box out of reach.
    pub async fn plan(&self, query: Query) -> Result<Planned, Error> {
        let entry = self
            .catalog
            .entry(&query.key())
            .ok_or_else(Error::lost_table)?;
        let sampler = self.samplers.get(&entry, &self.workers).await?;
        let planned = self
            .workers
            .run(move || Planned::new(query, entry, &sampler))
            .await??;
        let (count, limit) = (planned.count(), self.limits.max_points);
        if count > u128::from(limit) {
            return Err(Error::TooManyPoints { count, limit });
        }
        tracing::debug!(count, table = %planned.entry.key, "planned");
        Ok(planned)
    }

    /// What the points of a table look like.
    ///
    /// # Errors
    /// [`Error::Internal`] if it cannot be measured or drawn.
    pub async fn portrait(&self, entry: &Arc<Entry>) -> Result<Arc<Portrait>, Error> {
        self.portraits.get(entry, &self.workers).await
    }

    /// Streams the blocks of an answer. One that cannot be made to its end breaks off.
    pub fn blocks(
        &self,
        permit: Permit,
        answer: Answer,
    ) -> impl Stream<Item = Result<Bytes, Interrupted>> + use<> {
        let blocks = self.stream(permit, answer).map(|made| {
            made?.map_err(|error| {
                tracing::error!(%error, "an answer broke off");
                Interrupted::Failed
            })
        });
        // An empty block only says that there is more to do.
        blocks.filter(|block| {
            let said = !matches!(block, Ok(bytes) if bytes.is_empty());
            std::future::ready(said)
        })
    }

    /// Streams what an iterator makes, each item made on the workers when it is asked for.
    pub fn stream<I>(&self, permit: Permit, items: I) -> BlockStream<I>
    where
        I: Iterator + Send + 'static,
        I::Item: Send,
    {
        BlockStream::new(items, permit, self.workers.clone())
    }
}
