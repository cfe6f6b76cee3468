//! Streams of blocks: made on demand, one ahead, and dropped with their reader.
//!
//! The reader asks for a block; the iterator that makes blocks moves to a worker, makes one, and
//! moves back. While the reader takes a block the next one is made, and then nothing happens until
//! the reader comes back. So a stream holds the same few blocks whatever its length, a slow reader
//! blocks no thread, and a reader that goes away leaves at most one block to be finished and thrown
//! away.

use std::{
    pin::Pin,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
    task::{Context, Poll},
};

use futures_util::{FutureExt as _, Stream};
use tokio::sync::oneshot;
use tokio_util::sync::{CancellationToken, WaitForCancellationFutureOwned};

use super::{Error, Held, Workers};

/// Why a stream broke off: its reader must see that it is not complete.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Interrupted {
    /// The server stops and will not wait longer.
    #[error("the server is shutting down; the stream is not complete")]
    Shutdown,
    /// The reader took nothing for too long.
    #[error("nothing was taken of it for too long; the stream is not complete")]
    Stalled,
    /// It took longer than streams may.
    #[error("the time for it is over; the stream is not complete: go on with a cursor")]
    TimeOver,
    /// Making a block failed.
    #[error("an internal error; the stream is not complete")]
    Failed,
}

/// All streams under way: counts them, bounds them, ends them.
#[derive(Debug)]
pub struct Streams {
    open: AtomicUsize,
    limit: usize,
    stop: CancellationToken,
}

impl Streams {
    /// No streams, and at most `limit` at once.
    #[must_use]
    pub fn new(limit: usize) -> Self {
        Self {
            open: AtomicUsize::new(0),
            limit,
            stop: CancellationToken::new(),
        }
    }

    /// How many are under way, with those whose last block is still being made for nobody.
    #[must_use]
    pub fn open(&self) -> usize {
        self.open.load(Ordering::Acquire)
    }

    /// The right to start one more, which holds so much memory.
    ///
    /// # Errors
    /// [`Error::Busy`] if as many as allowed are under way, [`Error::ShuttingDown`] after
    /// [`stop`](Self::stop).
    pub fn admit(self: &Arc<Self>, held: Held) -> Result<Permit, Error> {
        if self.stop.is_cancelled() {
            return Err(Error::ShuttingDown);
        }
        let more = |open: usize| (open < self.limit).then_some(open + 1);
        self.open
            .fetch_update(Ordering::AcqRel, Ordering::Acquire, more)
            .map_err(|_| Error::Busy { limit: self.limit })?;
        Ok(Permit {
            streams: self.clone(),
            _held: held,
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
    _held: Held,
}

impl Drop for Permit {
    fn drop(&mut self) {
        self.streams.open.fetch_sub(1, Ordering::AcqRel);
    }
}

/// A maker of blocks with its permit, which goes wherever the maker goes.
struct Maker<I> {
    items: I,
    _permit: Permit,
}

/// What a worker hands back: the maker, unless it is done, and what it made.
type Made<I> = (Maker<I>, Option<<I as Iterator>::Item>);

enum State<I: Iterator> {
    /// Nobody has asked yet.
    Idle(Maker<I>),
    /// A block is being made, or waits to be taken.
    Making(oneshot::Receiver<Made<I>>),
    /// All is said.
    Over,
}

/// A stream of what an iterator makes.
pub struct BlockStream<I: Iterator> {
    state: State<I>,
    workers: Workers,
    stop: Pin<Box<WaitForCancellationFutureOwned>>,
}

impl<I> BlockStream<I>
where
    I: Iterator + Send + 'static,
    I::Item: Send,
{
    pub(super) fn new(items: I, permit: Permit, workers: Workers) -> Self {
        let stop = Box::pin(permit.streams.stop.clone().cancelled_owned());
        Self {
            state: State::Idle(Maker {
                items,
                _permit: permit,
            }),
            workers,
            stop,
        }
    }

    /// Sends the maker off to make one block.
    fn make(&self, mut maker: Maker<I>) -> State<I> {
        let (back, made) = oneshot::channel();
        self.workers.spawn(move || {
            if back.is_closed() {
                return;
            }
            let item = maker.items.next();
            let _ = back.send((maker, item));
        });
        State::Making(made)
    }
}

impl<I> Stream for BlockStream<I>
where
    I: Iterator + Send + Unpin + 'static,
    I::Item: Send,
{
    type Item = Result<I::Item, Interrupted>;

    fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        if matches!(self.state, State::Over) {
            return Poll::Ready(None);
        }
        if self.stop.poll_unpin(cx).is_ready() {
            self.state = State::Over;
            return Poll::Ready(Some(Err(Interrupted::Shutdown)));
        }
        loop {
            match std::mem::replace(&mut self.state, State::Over) {
                State::Idle(maker) => self.state = self.make(maker),
                State::Making(mut made) => {
                    let Poll::Ready(answer) = made.poll_unpin(cx) else {
                        self.state = State::Making(made);
                        return Poll::Pending;
                    };
                    return Poll::Ready(match answer {
                        Ok((maker, Some(item))) => {
                            self.state = self.make(maker);
                            Some(Ok(item))
                        }
                        Ok((_, None)) => None,
                        Err(_) => Some(Err(Interrupted::Failed)),
                    });
                }
                State::Over => return Poll::Ready(None),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::{
        task::Waker,
        time::{Duration, Instant},
    };

    use futures_util::StreamExt as _;

    use super::*;

    /// Counts what it makes, panics at some item, ends at another.
    struct Numbers {
        made: Arc<AtomicUsize>,
        panic_at: usize,
        end: usize,
    }

    impl Iterator for Numbers {
        type Item = usize;

        fn next(&mut self) -> Option<usize> {
            let i = self.made.load(Ordering::SeqCst);
            assert_ne!(i, self.panic_at, "as asked for");
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
        let permit = streams.admit(nothing()).expect("the first");
        let workers = Workers::new(1).expect("threads");
        (BlockStream::new(numbers, permit, workers), streams)
    }

    fn nothing() -> Held {
        Arc::new(crate::service::Budget::new(0))
            .hold(0)
            .expect("room")
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
        assert!(matches!(
            streams.admit(nothing()),
            Err(Error::Busy { limit: 1 })
        ));
        let items: Vec<_> = stream.collect().await;
        assert_eq!(items, (0..100).map(Ok).collect::<Vec<_>>());
        until(|| streams.open() == 0);
    }

    #[tokio::test]
    async fn nothing_is_made_before_it_is_asked_for_and_then_one_ahead() {
        let (numbers, made) = numbers(usize::MAX, 100);
        let (mut stream, streams) = stream(numbers);
        assert_eq!(made.load(Ordering::SeqCst), 0);
        for taken in 1..=10 {
            stream.next().await.expect("more").expect("whole");
            until(|| made.load(Ordering::SeqCst) == taken + 1);
        }
        drop(stream);
        until(|| streams.open() == 0);
        assert_eq!(made.load(Ordering::SeqCst), 11);
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
        assert!(matches!(streams.admit(nothing()), Err(Error::ShuttingDown)));
    }

    #[tokio::test]
    async fn a_waiting_reader_hears_of_the_stop() {
        let (numbers, _) = numbers(usize::MAX, usize::MAX);
        let (mut stream, streams) = stream(numbers);
        // The only worker is busy, so there is nothing to take.
        let (hold, held) = std::sync::mpsc::channel::<()>();
        stream.workers.spawn(move || {
            let _ = held.recv();
        });
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
