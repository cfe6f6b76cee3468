//! Streams of blocks: made on demand, a few ahead, and dropped with their reader.
//!
//! The reader asks for a block; the iterator that makes blocks moves to a worker, makes some, and
//! moves back. A reader that takes its time has one block ready, and nothing happens until it comes
//! back. A fast one has up to `MOST_AHEAD`: making goes on while blocks are sent, which is what text
//! needs, several blocks of which are written at once, and workers are woken for every other block at
//! most. So a stream holds the same few blocks whatever its length, a slow reader blocks no thread,
//! and a reader that goes away leaves at most one block to be finished and thrown away.

use std::{
    collections::VecDeque,
    pin::Pin,
    sync::{Arc, Weak},
    task::{Context, Poll, Waker},
    time::{Duration, Instant},
};

use crate::access::{OneOf, Place, Quota};
use futures_util::{FutureExt as _, Stream};
use parking_lot::Mutex;
use strew_error::Error;
use tokio_util::sync::{CancellationToken, WaitForCancellationFutureOwned};

use crate::{Held, Owner, Workers};

/// Why a stream broke off. Its reader must see that it is incomplete.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Interrupted {
    #[error("the server is shutting down; the stream is incomplete")]
    Shutdown,
    #[error("the client read nothing for too long; the stream is incomplete")]
    Stalled,
    #[error("the stream reached its time limit and is incomplete; resume from its cursor")]
    TimeOver,
    #[error("an internal error; the stream is incomplete")]
    Failed,
}

/// All streams under way: counts them, bounds them, ends them.
#[derive(Debug)]
pub struct Streams {
    open: Arc<Quota>,
    stop: CancellationToken,
}

impl Streams {
    /// No streams, and at most `limit` at once.
    pub fn new(limit: usize) -> Self {
        Self {
            open: Arc::new(Quota::new(limit)),
            stop: CancellationToken::new(),
        }
    }

    /// The number of open streams, including abandoned ones whose last block is still being computed.
    pub fn open(&self) -> usize {
        self.open.used()
    }

    pub(super) fn places(&self) -> &Quota {
        &self.open
    }

    /// Admits one more stream.
    ///
    /// # Errors
    /// [`Error::Busy`] if the limit of open streams is reached, [`Error::ShuttingDown`] after [`stop`](Self::stop).
    pub fn admit(self: &Arc<Self>) -> Result<Permit, Error> {
        if self.stop.is_cancelled() {
            return Err(Error::ShuttingDown);
        }
        let limit = self.open.limit();
        let one = self.open.clone().one().ok_or(Error::Busy { limit })?;
        Ok(Permit {
            streams: self.clone(),
            _one: one,
            _place: None,
            _held: None,
        })
    }

    /// Breaks off every stream and admits no more.
    pub fn stop(&self) {
        self.stop.cancel();
    }
}

/// The right to run one stream; given back when dropped.
#[derive(Debug)]
pub struct Permit {
    streams: Arc<Streams>,
    _one: OneOf,
    _place: Option<Place>,
    _held: Option<Held>,
}

impl Permit {
    /// With a place of the caller's and memory that are given back with it.
    pub(super) fn with(mut self, place: Place, held: Held) -> Self {
        self._place = Some(place);
        self._held = Some(held);
        self
    }
}

/// A maker of blocks with its permit, which goes wherever the maker goes.
struct Maker<I> {
    items: I,
    _permit: Permit,
}

/// The most blocks that are made ahead of a reader.
const MOST_AHEAD: usize = 4;

/// A reader that comes back within this time is quick.
const QUICK: Duration = Duration::from_millis(10);

/// A reader is fast once it was quick so often: not yet while it fills the buffers of its socket, a
/// few megabytes, nor when a slow one empties a part of them at once.
const OFTEN: u32 = 32;

/// The state that a reader shares with the worker that makes its blocks.
struct Shared<I: Iterator> {
    ready: VecDeque<I::Item>,
    ahead: usize,
    /// The maker, unless a worker has it.
    maker: Option<Maker<I>>,
    /// The end of the stream, once it has ended.
    end: Option<Result<(), Interrupted>>,
    /// The reader, while it waits.
    reader: Option<Waker>,
}

impl<I: Iterator> Shared<I> {
    fn wake(&mut self) {
        if let Some(reader) = self.reader.take() {
            reader.wake();
        }
    }
}

pub struct BlockStream<I: Iterator> {
    /// The shared state; none after the end.
    shared: Option<Arc<Mutex<Shared<I>>>>,
    workers: Workers,
    owner: Owner,
    stop: Pin<Box<WaitForCancellationFutureOwned>>,
    /// When the last block was taken.
    taken: Instant,
    /// How often the reader was quick; halved when it was not.
    quick: u32,
}

impl<I> BlockStream<I>
where
    I: Iterator + Send + 'static,
    I::Item: Send,
{
    pub(super) fn new(items: I, permit: Permit, workers: Workers) -> Self {
        let stop = Box::pin(permit.streams.stop.clone().cancelled_owned());
        let shared = Shared {
            ready: VecDeque::new(),
            ahead: 1,
            maker: Some(Maker {
                items,
                _permit: permit,
            }),
            end: None,
            reader: None,
        };
        Self {
            shared: Some(Arc::new(Mutex::new(shared))),
            workers,
            owner: Owner::current(),
            stop,
            taken: Instant::now(),
            quick: 0,
        }
    }
}

/// A maker under way on a worker. If it is dropped there, making a block has failed.
struct Turn<I: Iterator> {
    maker: Option<Maker<I>>,
    shared: Weak<Mutex<Shared<I>>>,
}

impl<I: Iterator> Turn<I> {
    /// Makes blocks until enough are ready. One turn makes no more than that, however fast the reader is, so that other
    /// streams have their turns.
    fn run(mut self) {
        for made in 1.. {
            let (Some(maker), true) = (&mut self.maker, self.shared.strong_count() > 0) else {
                return;
            };
            let item = maker.items.next();
            let Some(shared) = self.shared.upgrade() else {
                return;
            };
            // A finished maker is dropped after the lock is released.
            let mut over = None;
            let mut shared = shared.lock();
            match item {
                Some(item) => shared.ready.push_back(item),
                None => {
                    shared.end = Some(Ok(()));
                    over = self.maker.take();
                }
            }
            let is_enough = shared.ready.len() >= shared.ahead || made >= MOST_AHEAD;
            if is_enough {
                shared.maker = self.maker.take();
            }
            shared.wake();
            drop(shared);
            drop(over);
            if is_enough {
                return;
            }
        }
    }
}

impl<I: Iterator> Drop for Turn<I> {
    fn drop(&mut self) {
        let Some(maker) = self.maker.take() else {
            return;
        };
        drop(maker);
        if let Some(shared) = self.shared.upgrade() {
            let mut shared = shared.lock();
            shared.end = Some(Err(Interrupted::Failed));
            shared.wake();
        }
    }
}

impl<I> Stream for BlockStream<I>
where
    I: Iterator + Send + Unpin + 'static,
    I::Item: Send,
{
    type Item = Result<I::Item, Interrupted>;

    fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        let Some(all) = self.shared.clone() else {
            return Poll::Ready(None);
        };
        if self.stop.poll_unpin(cx).is_ready() {
            self.shared = None;
            return Poll::Ready(Some(Err(Interrupted::Shutdown)));
        }
        let mut shared = all.lock();
        let item = shared.ready.pop_front();
        if item.is_none() {
            if let Some(end) = shared.end {
                self.shared = None;
                return Poll::Ready(end.err().map(Err));
            }
            shared.reader = Some(cx.waker().clone());
        } else {
            let now = Instant::now();
            self.quick = if now - self.taken < QUICK {
                (self.quick + 1).min(2 * OFTEN)
            } else {
                self.quick / 2
            };
            let is_fast = self.quick >= OFTEN;
            shared.ahead = if is_fast { MOST_AHEAD } else { 1 };
            self.taken = now;
        }
        // Workers are not woken for each block: that takes about as long as making one.
        if shared.ready.len() <= shared.ahead / 2
            && let Some(maker) = shared.maker.take()
        {
            let turn = Turn {
                maker: Some(maker),
                shared: Arc::downgrade(&all),
            };
            drop(shared);
            let lane = self.owner.lane();
            self.workers.take_piece(&self.owner, lane, || turn.run());
        }
        match item {
            Some(item) => Poll::Ready(Some(Ok(item))),
            None => Poll::Pending,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use futures_util::StreamExt as _;
    use strew_plan::Lane;

    use super::*;

    /// An iterator that counts its items, panics at one and ends at another.
    struct Numbers {
        made: Arc<AtomicUsize>,
        panic_at: usize,
        end: usize,
    }

    impl Iterator for Numbers {
        type Item = usize;

        fn next(&mut self) -> Option<usize> {
            let i = self.made.load(Ordering::SeqCst);
            assert_ne!(i, self.panic_at, "the panic of the test");
            (i < self.end).then(|| self.made.fetch_add(1, Ordering::SeqCst))
        }
    }

    fn numbers(panic_at: usize, end: usize) -> (Numbers, Arc<AtomicUsize>) {
        let made = Arc::new(AtomicUsize::new(0));
        let numbers = Numbers {
            made: made.clone(),
            panic_at,
            end,
        };
        (numbers, made)
    }

    fn stream(numbers: Numbers) -> (BlockStream<Numbers>, Arc<Streams>) {
        let streams = Arc::new(Streams::new(1));
        let permit = streams.admit().expect("the first");
        let workers = Workers::new(1);
        (BlockStream::new(numbers, permit, workers), streams)
    }

    fn until(what: impl Fn() -> bool) {
        let start = Instant::now();
        while !what() {
            assert!(start.elapsed() < Duration::from_secs(10), "in vain");
            std::thread::yield_now();
        }
    }

    #[tokio::test]
    async fn everything_comes_in_order_and_the_place_is_free_again() {
        let (numbers, _) = numbers(usize::MAX, 100);
        let (stream, streams) = stream(numbers);
        assert_eq!(streams.open(), 1);
        assert!(matches!(streams.admit(), Err(Error::Busy { limit: 1 })));
        let items: Vec<_> = stream.collect().await;
        assert_eq!(items, (0..100).map(Ok).collect::<Vec<_>>());
        until(|| streams.open() == 0);
    }

    #[tokio::test]
    async fn nothing_is_made_before_it_is_asked_for_and_then_a_few_ahead() {
        let (numbers, made) = numbers(usize::MAX, 100);
        let (mut stream, streams) = stream(numbers);
        assert_eq!(made.load(Ordering::SeqCst), 0);
        for taken in 1..=10 {
            stream.next().await.expect("more").expect("whole");
            until(|| made.load(Ordering::SeqCst) > taken);
            assert!(made.load(Ordering::SeqCst) <= taken + MOST_AHEAD);
        }
        drop(stream);
        until(|| streams.open() == 0);
        assert!(made.load(Ordering::SeqCst) <= 10 + MOST_AHEAD);
    }

    #[tokio::test]
    async fn a_fast_reader_has_more_ahead_than_one_that_takes_its_time() {
        let (numbers, made) = numbers(usize::MAX, 1000);
        let (mut stream, streams) = stream(numbers);
        let minute = Duration::from_secs(60);
        for taken in 1..100 {
            let now = Instant::now();
            stream.taken = if taken <= 70 {
                now + minute
            } else {
                now - minute
            };
            stream.next().await.expect("more").expect("whole");
            let is_fast = (OFTEN as usize..=70).contains(&taken);
            let least = if is_fast { MOST_AHEAD - 1 } else { 1 };
            until(|| made.load(Ordering::SeqCst) >= taken + least);
            let ahead = made.load(Ordering::SeqCst) - taken;
            let most = if (OFTEN as usize..80).contains(&taken) {
                MOST_AHEAD
            } else {
                1
            };
            assert!(ahead <= most, "{ahead} after {taken}");
        }
        drop(stream);
        until(|| streams.open() == 0);
    }

    #[tokio::test]
    async fn a_failure_is_an_error_and_not_an_end() {
        let (numbers, _) = numbers(3, 100);
        let (stream, streams) = stream(numbers);
        let items: Vec<_> = stream.collect().await;
        assert_eq!(items, [Ok(0), Ok(1), Ok(2), Err(Interrupted::Failed)]);
        until(|| streams.open() == 0);
    }

    #[tokio::test]
    async fn a_stop_is_an_error_and_not_an_end() {
        let (numbers, _) = numbers(usize::MAX, usize::MAX);
        let (mut stream, streams) = stream(numbers);
        assert_eq!(stream.next().await, Some(Ok(0)));
        streams.stop();
        let rest: Vec<_> = stream.collect().await;
        assert_eq!(rest, [Err(Interrupted::Shutdown)]);
        until(|| streams.open() == 0);
        assert!(matches!(streams.admit(), Err(Error::ShuttingDown)));
    }

    #[tokio::test]
    async fn a_waiting_reader_hears_of_the_stop() {
        let (numbers, _) = numbers(usize::MAX, usize::MAX);
        let (mut stream, streams) = stream(numbers);
        // The only worker is busy, so there is nothing to take.
        let (hold, held) = std::sync::mpsc::channel::<()>();
        let busy = move || assert!(held.recv().is_err());
        stream.workers.take_piece(&stream.owner, Lane::Short, busy);
        let mut context = Context::from_waker(Waker::noop());
        assert!(stream.poll_next_unpin(&mut context).is_pending());
        let reader = tokio::spawn(stream.collect::<Vec<_>>());
        streams.stop();
        let rest = reader.await.expect("no panic");
        assert_eq!(rest, [Err(Interrupted::Shutdown)]);
        drop(hold);
        until(|| streams.open() == 0);
    }
}
