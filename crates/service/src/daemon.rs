//! The service of a daemon: the state that requests share, and how each request is answered.
//!
//! All requests share tables, samplers and threads. Work runs on the workers, callers are charged for its price, and
//! streams hold their share of memory to the end. A program that embeds the service without any of this uses a
//! [`Library`](strew_plan::Library).

use std::{fmt, path::PathBuf, pin::pin, sync::Arc};

use crate::access::Caller;
use arc_swap::ArcSwap;
use bytes::Bytes;
use futures_util::{Stream, StreamExt as _};
use moka::future::Cache;
use strew_catalog::{
    Entry, Ready, Reload,
    except::NamedList,
    field::{self, Document, NamedField},
};
use strew_config::{Config, Limits};
use strew_core::server::{Stop, Visits};
use strew_encode::{Answer, Index, Output, Piece};
use strew_error::Error;
use strew_plan::{
    Found, Lane, Neighbors, Placed, Planned, considered, effort, library,
    store::{self, Need},
};
use strew_query::{Assets, Draft, Nearest, Options, Query, Set, Token};

use crate::{
    BlockStream, Budget, Held, Interrupted, Permit, PointsInFlight, Portrait, Record, Streams,
    Workers,
    cache::{CacheState, Samplers},
    mixes::Mixes,
    portrait,
    record::{Recorded, allowance},
};

/// Everything a front end needs. Cheap to share behind an [`Arc`].
pub struct Service {
    assets: ArcSwap<Assets>,
    limits: Limits,
    samplers: Samplers,
    mixes: Mixes,
    /// By the digest of a table.
    portraits: Cache<String, Arc<Portrait>>,
    /// Where the bytes of answers lie, by the tag of an answer.
    indices: Cache<Vec<u8>, Arc<Index>>,
    streams: Arc<Streams>,
    points_in_flight: PointsInFlight,
    budget: Budget,
    pub(super) workers: Workers,
}

/// The memory of the indices that are kept: a footer has about a thousandth of the bytes of its file.
const INDEX_BYTES: u64 = 16 << 20;

impl fmt::Debug for Service {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Service")
    }
}

impl Service {
    pub fn new(assets: impl Into<Assets>, limits: Limits, workers: Workers) -> Self {
        let samplers = Samplers::new(limits.cache_bytes);
        let budget = Budget::new(limits.max_bytes_in_flight);
        Self {
            mixes: Mixes::new(samplers.clone(), budget.clone(), None),
            samplers,
            portraits: Cache::new(portrait::MOST),
            indices: Cache::builder()
                .name("indices")
                .max_capacity(INDEX_BYTES)
                .weigher(|_, index: &Arc<Index>| 2048 + (index.size() >> 10) as u32)
                .build(),
            streams: Arc::new(Streams::new(limits.max_streams)),
            points_in_flight: PointsInFlight::default(),
            budget,
            assets: ArcSwap::from_pointee(assets.into()),
            limits,
            workers,
        }
    }

    /// The service with a folder of mixes, where those are kept that queries have made.
    pub fn with_mixes(self, folder: Option<PathBuf>) -> Self {
        Self {
            mixes: Mixes::new(self.samplers.clone(), self.budget.clone(), folder),
            ..self
        }
    }

    /// Everything that queries may name now. A query holds on to the tables that it was checked against.
    pub fn catalog(&self) -> Arc<Assets> {
        self.assets.load_full()
    }

    /// Reads the folders and the names of the configuration again. Invalid documents are refused, and their earlier
    /// versions stay.
    pub fn read_tables(&self, config: &Config) -> (Assets, Reload) {
        self.catalog().reload(config)
    }

    /// Serves the tables that were read, all at once. Reloads come one after another.
    pub async fn serve_tables(&self, (after, reload): (Assets, Reload)) -> Reload {
        self.assets.store(Arc::new(after));
        for digest in reload.gone() {
            self.samplers.forget(digest).await;
        }
        reload
    }

    pub fn hold_field(&self, document: Document, stop: &Stop) -> Result<Arc<NamedField>, Error> {
        let (catalog, sender) = (self.catalog(), self.own_budget().sender());
        library::hold_field(
            &catalog,
            document,
            field::MOST_PIXELS,
            allowance(stop),
            sender,
        )
    }

    /// Reads and holds a list of points that a client sends, under its digest.
    pub fn hold_list(&self, body: &[u8]) -> Result<Arc<NamedList>, Error> {
        let (catalog, budget) = (self.catalog(), self.own_budget());
        let lists = catalog.except();
        let _held = budget.hold(lists.reading(body))?;
        let text = String::from_utf8_lossy(body);
        Ok(lists.hold(&text, budget.sender())?)
    }

    pub const fn limits(&self) -> &Limits {
        &self.limits
    }

    pub const fn workers(&self) -> &Workers {
        &self.workers
    }

    pub async fn cache(&self) -> CacheState {
        self.samplers.state().await
    }

    pub const fn streams(&self) -> &Arc<Streams> {
        &self.streams
    }

    pub const fn points_in_flight(&self) -> &PointsInFlight {
        &self.points_in_flight
    }

    /// The byte budget of all requests and answers.
    pub const fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Checks a query against the tables that are loaded and the limits.
    pub fn check(&self, draft: &Draft, stop: &Stop) -> Result<(Box<Query>, Options), Error> {
        let (catalog, vertices) = (self.catalog(), self.limits.max_vertices);
        let allowance = allowance(stop);
        let (query, options) = draft.check_within(&catalog, vertices, allowance)?;
        Ok((query.into(), options))
    }

    /// Admits a caller and plans a query whose points are to be made, charging the points considered.
    pub async fn open(
        &self,
        caller: &Caller,
        query: Box<Query>,
        output: Option<&Output>,
    ) -> Result<(Permit, Planned), Error> {
        /// The pixels of a picture that are drawn and packed in a microsecond.
        const PIXELS: u128 = 500;
        // Waiting for labels takes no place.
        let tables = self.tables(caller, &query).await?;
        let permit = self.admit(caller, output.map_or(0, Output::room))?;
        let planned = self.charged(caller, query, tables).await?;
        self.check_points(caller, &planned)?;
        let picture = output.filter(|output| output.encoding.traits().is_picture);
        let drawn = picture.map_or(0, |output| output.room() as u128 / PIXELS);
        caller.charge(considered(&planned) + drawn)?;
        // No more than the limit, which has 64 bits.
        let points = u64::try_from(planned.count()).unwrap_or(u64::MAX);
        Record::promise(&self.points_in_flight, points);
        Ok((permit, planned))
    }

    /// The byte budget of the request that is being answered.
    pub fn own_budget(&self) -> Budget {
        let record = Record::current();
        record.map_or_else(|| self.budget.clone(), |record| record.budget().clone())
    }

    /// Takes bytes of the budget for the request that is being answered.
    pub fn hold(&self, bytes: usize) -> Result<Held, Error> {
        self.own_budget().hold(bytes)
    }

    /// Plans a query on the workers, whatever it counts. Charges the rows that are counted one by one.
    pub async fn count(&self, caller: &Caller, query: Box<Query>) -> Result<Planned, Error> {
        let tables = self.tables(caller, &query).await?;
        self.charged(caller, query, tables).await
    }

    async fn tables(&self, caller: &Caller, query: &Query) -> Result<Vec<Ready>, Error> {
        let mut tables = Vec::with_capacity(query.sets.len());
        // Tables in space are ready as they are.
        for set in query.sets.iter().filter(|set| set.space().is_none()) {
            tables.push(self.ready(caller, set).await?);
        }
        Ok(tables)
    }

    async fn charged(
        &self,
        caller: &Caller,
        query: Box<Query>,
        tables: Vec<Ready>,
    ) -> Result<Planned, Error> {
        let planned = if query.is_small() {
            // Handing it over would take longer.
            Planned::new(query, &tables, &self.limits)?
        } else {
            // On the heap, lest small boxes have room for it.
            let limits = self.limits.clone();
            Box::pin(self.planned_in_turns(caller, query, tables, limits)).await?
        };
        tracing::debug!(count = planned.count(), table = %planned.entry().key, "planned");
        if let Some(record) = Record::current() {
            record.take_lane(effort::block_lane(&planned));
        }
        Ok(planned)
    }

    /// Plans a query on the workers, as its price says, and charges for it.
    async fn planned_in_turns(
        &self,
        caller: &Caller,
        query: Box<Query>,
        tables: Vec<Ready>,
        limits: Limits,
    ) -> Result<Planned, Error> {
        let most = limits.max_rows;
        let is_plain = effort::is_plain(&query);
        let price = move |stop: &Stop| {
            let rows = effort::planning(&query, &tables, most, stop);
            (rows, query, tables)
        };
        let (rows, query, tables) = match is_plain {
            true => price(&Stop::default()),
            false => self.workers.take_turn(Lane::Short, price).await?,
        };
        let rows = rows?;
        // Before the work, which is done even if the answer is refused.
        if rows >= 1.0 {
            caller.charge(rows as u128)?;
        }
        let plan = move |stop: &Stop| Planned::unless_stopped(query, &tables, &limits, stop);
        self.workers.take_turn(effort::lane(rows), plan).await?
    }

    /// The table of a set, ready to answer. Making a mix is charged.
    async fn ready(&self, caller: &Caller, set: &Set) -> Result<Ready, Error> {
        /// Making a mix takes about as long as making this many points for each block.
        const POINTS: u128 = 10_000;
        let ready = self.samplers.get(&set.entry, &self.workers).await?;
        let made = match store::needs(&ready, set) {
            None => return Ok(ready),
            Some(Need::Loaded(entry)) => self.samplers.get(&entry, &self.workers).await?,
            Some(Need::Made(what)) => match self.mixes.known(&ready, &what, &self.workers).await? {
                Some(known) => known,
                None => {
                    caller.charge(POINTS * set.entry.blocks() as u128)?;
                    let _making = Record::making();
                    Box::pin(self.mixes.get(&ready, &what, &self.workers)).await?
                }
            },
        };
        Ok(store::with_made(ready, set, made.table))
    }

    /// Admits one more stream of a caller, which is made in so many bytes besides blocks, rows and text.
    pub(super) fn admit(&self, caller: &Caller, room: usize) -> Result<Permit, Error> {
        /// The bytes in which rows and text are made, besides blocks.
        const ROWS: usize = 2 << 20;
        let blocks = self.limits.block_bytes.saturating_mul(4);
        let held = blocks.saturating_add(ROWS).saturating_add(room);
        let place = caller.place(self.streams.places())?;
        let permit = self.streams.admit()?;
        Ok(permit.with(place, self.hold(held)?))
    }

    pub async fn plan(&self, caller: &Caller, query: Box<Query>) -> Result<Planned, Error> {
        let planned = self.count(caller, query).await?;
        self.check_points(caller, &planned)?;
        Ok(planned)
    }

    /// Refuses more points than a caller may have.
    fn check_points(&self, caller: &Caller, planned: &Planned) -> Result<(), Error> {
        let limit = caller.max_points(self.limits.max_points);
        let count = planned.count();
        if count > u128::from(limit) {
            return Err(Error::TooManyPoints { count, limit });
        }
        Ok(())
    }

    /// The query in parts; see [`Planned::split`]. Charges the rows that are counted for them.
    pub async fn split(
        &self,
        caller: &Caller,
        planned: Planned,
        parts: u32,
    ) -> Result<Vec<(Token, u64)>, Error> {
        caller.charge(effort::splitting(&planned, parts) as u128)?;
        let split = move |stop: &Stop| planned.stopped_by(stop).split(parts);
        self.workers.take_turn(Lane::Long, split).await?
    }

    pub async fn place(&self, caller: &Caller, set: Box<Set>) -> Result<Placed, Error> {
        if set.space().is_some() {
            return Placed::in_space(set);
        }
        let ready = self.ready(caller, &set).await?;
        Placed::new(set, ready)
    }

    /// The answer about the points of a set nearest to a place, made where they are found: there may be
    /// thousands. Charges them.
    pub async fn nearest<T: Send + 'static>(
        &self,
        caller: &Caller,
        set: Box<Set>,
        nearest: Nearest,
        answer: impl FnOnce(&Placed, Vec<Found>) -> Result<T, Error> + Send + 'static,
    ) -> Result<T, Error> {
        let placed = self.place(caller, set).await?;
        let effort = Neighbors::of(&placed, &nearest);
        let (budget, caller) = (self.own_budget(), caller.clone());
        let most = effort.visits(self.limits.max_rows);
        let search = move |stop: &Stop| {
            let _held = budget.hold(effort.bytes)?;
            let visits = Visits::new(most, stop.clone());
            let found = placed.nearest_visiting(nearest, &visits)?;
            // Points that are thinned out take as long to find.
            let considered = found.len() as f64 / placed.set.keep.get();
            caller.charge(effort.considered(considered, visits.made()))?;
            answer(&placed, found)
        };
        self.workers.take_turn(effort.lane, search).await?
    }

    pub async fn portrait(&self, entry: &Arc<Entry>) -> Result<Arc<Portrait>, Error> {
        let make = async {
            let entry = entry.clone();
            let draw = move |_: &_| Portrait::new(&entry).map(Arc::new);
            self.workers.take_turn(Lane::Making, draw).await?
        };
        let made = self
            .portraits
            .try_get_with_by_ref(&entry.digest, make)
            .await;
        made.map_err(|error| (*error).clone())
    }

    /// All of the answer to a [small](Query::is_small) query: handing it to the workers block by
    /// block would take longer than making it.
    pub fn at_once(&self, answer: Answer) -> Result<Bytes, Error> {
        let mut whole = Bytes::new();
        for block in Recorded::new(answer) {
            let block = block?;
            whole = match (whole.is_empty(), block.is_empty()) {
                (true, _) => block,
                (false, true) => whole,
                (false, false) => [whole, block].concat().into(),
            };
        }
        Ok(whole)
    }

    /// Where the bytes of an answer in blocks lie, which is not known before all are made: once for each tag.
    pub async fn index(
        &self,
        tag: Vec<u8>,
        open: impl Future<Output = Result<(Permit, Answer), Error>>,
    ) -> Result<Arc<Index>, Error> {
        let make = async {
            let (permit, answer) = open.await?;
            let Some(Piece::Points(each)) = answer.piece() else {
                return Err(Error::Internal("an answer has no blocks"));
            };
            let mut blocks = pin!(self.blocks(permit, answer));
            let (mut front, mut last) = (None, Bytes::new());
            let (mut end, mut ends) = (0, vec![]);
            while let Some(block) = blocks.next().await {
                last = block.map_err(|_| Error::Internal("an answer broke off"))?;
                if front.is_none() {
                    front = Some(last.clone());
                } else {
                    end += last.len() as u64;
                    ends.push(end);
                }
            }
            ends.pop();
            let front = front.unwrap_or_default();
            Ok(Arc::new(Index::ending(front, each, ends, last)))
        };
        let made = Box::pin(self.indices.try_get_with(tag, make)).await;
        made.map_err(|error| (*error).clone())
    }

    /// Streams the blocks of an answer. One that cannot be made to its end breaks off.
    pub fn blocks(
        &self,
        permit: Permit,
        answer: Answer,
    ) -> impl Stream<Item = Result<Bytes, Interrupted>> + use<> {
        let blocks = self.stream(permit, Recorded::new(answer)).map(|made| {
            made?.map_err(|error| {
                tracing::error!(%error, "an answer broke off");
                Interrupted::Failed
            })
        });
        // An empty block means that the answer continues.
        blocks.filter(|block| {
            let said = !matches!(block, Ok(bytes) if bytes.is_empty());
            std::future::ready(said)
        })
    }

    /// Streams what an iterator makes, each item made on the workers when the reader wants it.
    pub fn stream<I>(&self, permit: Permit, items: I) -> BlockStream<I>
    where
        I: Iterator + Send + 'static,
        I::Item: Send,
    {
        BlockStream::new(items, permit, self.workers.clone())
    }
}
