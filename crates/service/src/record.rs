//! The record of an answer while it is made, for the log and the metrics.
//!
//! The server makes a [`Record`] for each request and answers within its scope. The code that answers
//! writes down what only it knows: the format, the points, the reason of a refusal. So REST and gRPC
//! need no counters. The record also has the byte budget of the request and the lane of its work.

use std::{
    sync::{
        Arc, OnceLock,
        atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering},
    },
    time::Duration,
};

use parking_lot::Mutex;
use strew_catalog::field::Allowance;
use strew_core::server::Stop;
use strew_encode::{Answer, EncodeError};
use strew_error::{Error, Kind};
use strew_plan::Lane;

use crate::{Budget, Held, PointsInFlight, access::Caller, promise::Promise, work::Clock};

tokio::task_local! {
    static CURRENT: Arc<Record>;
}

/// The facts about one request and its answer.
#[derive(Debug)]
pub struct Record {
    id: Box<str>,
    trace: Option<Box<str>>,
    budget: Budget,
    route: OnceLock<Box<str>>,
    format: OnceLock<&'static str>,
    refused: OnceLock<Kind>,
    points: AtomicU64,
    promise: OnceLock<Promise>,
    is_long: AtomicBool,
    is_making: AtomicBool,
    is_expected: AtomicBool,
    code: AtomicU32,
    clock: Clock,
    caller: OnceLock<Caller>,
    held: Mutex<Option<Held>>,
}

/// The request that is being answered waits for kinds to be made, until this is dropped.
#[derive(Debug)]
pub(super) struct Making(Option<Arc<Record>>);

impl Drop for Making {
    fn drop(&mut self) {
        if let Some(record) = &self.0 {
            record.is_making.store(false, Ordering::Relaxed);
        }
    }
}

const NONE: u32 = u32::MAX;

impl Record {
    /// Of a request with this id, in a trace or in none, which takes its memory from a budget.
    pub fn new(id: impl Into<Box<str>>, trace: Option<&str>, budget: Budget) -> Arc<Self> {
        Arc::new(Self {
            id: id.into(),
            trace: trace.map(Into::into),
            budget,
            route: OnceLock::new(),
            format: OnceLock::new(),
            refused: OnceLock::new(),
            points: AtomicU64::new(0),
            promise: OnceLock::new(),
            is_long: AtomicBool::new(false),
            is_making: AtomicBool::new(false),
            is_expected: AtomicBool::new(false),
            code: AtomicU32::new(NONE),
            clock: Clock::default(),
            caller: OnceLock::new(),
            held: Mutex::default(),
        })
    }

    /// Runs a future in which [`current`](Self::current) is this record.
    pub fn scope<F: Future>(self: Arc<Self>, future: F) -> impl Future<Output = F::Output> {
        CURRENT.scope(self, future)
    }

    /// The record of the request that is being answered, if it has one: a command line's has none.
    pub fn current() -> Option<Arc<Self>> {
        CURRENT.try_with(Arc::clone).ok()
    }

    /// Runs a job for a request outside of its task, with the request as its [`current`](Self::current) one.
    pub fn within<T>(record: Option<Arc<Self>>, job: impl FnOnce() -> T) -> T {
        match record {
            Some(record) => CURRENT.sync_scope(record, job),
            None => job(),
        }
    }

    /// Takes memory for the data that the current request includes, until its answer is complete.
    pub(super) fn hold(bytes: usize) -> Result<(), Error> {
        let Some(record) = Self::current() else {
            return Ok(());
        };
        let mut held = record.held.lock();
        match &mut *held {
            Some(held) => held.grow(bytes),
            none => {
                *none = Some(record.budget.hold(bytes)?);
                Ok(())
            }
        }
    }

    pub fn at(route: &str) {
        let _ = CURRENT.try_with(|record| record.route.set(route.into()));
    }

    /// The route, if the path of the request leads to one.
    pub fn route(&self) -> Option<&str> {
        self.route.get().map(|route| &**route)
    }

    pub fn refuse(kind: Kind) {
        let _ = CURRENT.try_with(|record| record.refused.set(kind));
    }

    /// Notes who pays for the work of the request that is being answered.
    pub fn of(caller: &Caller) {
        let _ = CURRENT.try_with(|record| record.caller.set(caller.clone()));
    }

    pub(super) fn took(&self, time: Duration) {
        if let Some(caller) = self.caller.get() {
            caller.took(time);
        }
    }

    pub fn in_format(name: &'static str) {
        let _ = CURRENT.try_with(|record| record.format.set(name));
    }

    /// The byte budget of the request.
    pub const fn budget(&self) -> &Budget {
        &self.budget
    }

    pub const fn clock(&self) -> &Clock {
        &self.clock
    }

    pub fn id(&self) -> &str {
        &self.id
    }

    /// The name of the trace that the request is in, if it is in one.
    pub fn trace(&self) -> Option<&str> {
        self.trace.as_deref()
    }

    /// The format of the answer, if it has points.
    pub fn format(&self) -> Option<&'static str> {
        self.format.get().copied()
    }

    /// Why it was refused, if it was.
    pub fn refused(&self) -> Option<Kind> {
        self.refused.get().copied()
    }

    /// The number of points made for it so far.
    pub fn points(&self) -> u64 {
        self.points.load(Ordering::Relaxed)
    }

    pub fn made(&self, points: u64) {
        self.points.fetch_add(points, Ordering::Relaxed);
        if let Some(promise) = self.promise.get() {
            promise.keep(points);
        }
    }

    /// Notes that the request is going to be answered with this many points, which are in flight until they are
    /// made or the request is over.
    pub(super) fn promise(all: &PointsInFlight, points: u64) {
        let _ = CURRENT.try_with(|record| record.promise.set(all.promise(points)));
    }

    pub(super) fn lane(&self) -> Lane {
        match self.is_long.load(Ordering::Relaxed) {
            true => Lane::Long,
            false => Lane::Short,
        }
    }

    /// Chooses the lane in which the blocks of the answer are made.
    pub(super) fn take_lane(&self, lane: Lane) {
        self.is_long.store(lane == Lane::Long, Ordering::Relaxed);
    }

    /// Notes that the request that is being answered waits for kinds to be made.
    pub(super) fn making() -> Making {
        let record = Self::current();
        if let Some(record) = &record {
            record.is_making.store(true, Ordering::Relaxed);
        }
        Making(record)
    }

    /// Notes that the answer has reached its time limit. Returns whether the request waits for kinds to be made; its
    /// client then retries.
    pub fn come_back(&self) -> bool {
        let is_making = self.is_making.load(Ordering::Relaxed);
        self.is_expected.store(is_making, Ordering::Relaxed);
        is_making
    }

    pub(super) fn is_expected(&self) -> bool {
        self.is_expected.load(Ordering::Relaxed)
    }

    /// The code with which a call ended, where the protocol sends it after the answer.
    pub fn code(&self) -> Option<u32> {
        Some(self.code.load(Ordering::Relaxed)).filter(|&code| code != NONE)
    }

    pub fn ended(&self, code: u32) {
        self.code.store(code, Ordering::Relaxed);
    }
}

pub fn allowance(stop: &Stop) -> Allowance<'_> {
    Allowance {
        stop,
        hold: &Record::hold,
    }
}

/// An answer whose points are noted as they are made, wherever that is.
#[derive(Debug)]
pub(super) struct Recorded {
    answer: Answer,
    noted: u64,
    record: Option<Arc<Record>>,
}

impl Recorded {
    pub(super) fn new(answer: Answer) -> Self {
        Self {
            answer,
            noted: 0,
            record: Record::current(),
        }
    }
}

impl Iterator for Recorded {
    type Item = Result<bytes::Bytes, EncodeError>;

    fn next(&mut self) -> Option<Self::Item> {
        let block = self.answer.next();
        if let Some(record) = &self.record {
            let points = self.answer.points();
            record.made(points.saturating_sub(self.noted));
            self.noted = points;
        }
        block
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn notes_go_to_the_record_of_the_task_and_nowhere_else() {
        Record::refuse(Kind::Busy);
        assert!(Record::current().is_none());
        let (a, b) = (
            Record::new("a", None, Budget::new(1)),
            Record::new("b", None, Budget::new(1)),
        );
        let noted = |kind| async move {
            tokio::task::yield_now().await;
            Record::refuse(kind);
            Record::in_format("csv");
        };
        tokio::join!(
            a.clone().scope(noted(Kind::Busy)),
            b.clone().scope(noted(Kind::Internal))
        );
        assert_eq!(a.refused(), Some(Kind::Busy));
        assert_eq!(b.refused(), Some(Kind::Internal));
        assert_eq!((a.format(), a.id(), b.id()), (Some("csv"), "a", "b"));
        assert_eq!(a.code(), None);
    }

    #[tokio::test]
    async fn what_a_request_brings_along_is_held_until_it_is_over() {
        let budget = Budget::new(100);
        let record = Record::new("a", None, budget.clone());
        let job = async {
            let record = Record::current();
            let there = std::thread::spawn(|| {
                Record::within(record, || {
                    (Record::hold(60), Record::hold(30), Record::hold(11))
                })
            });
            there.join().expect("no panic")
        };
        let (first, second, third) = record.clone().scope(job).await;
        assert!(first.is_ok() && second.is_ok() && third.is_err());
        assert_eq!(budget.held(), 90);
        drop(record);
        assert_eq!(budget.held(), 0);
        assert!(Record::hold(1000).is_ok());
    }
}
