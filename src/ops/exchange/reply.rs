//! An exchange from the head of its request until the socket has taken the last byte of its answer,
//! and the body of that answer.
//!
//! All answers by both protocols leave through [`Reply`]. Each frame leaves as [`Bytes`] whose owner
//! holds its share of the byte budget: HTTP, TLS and the socket drop it when it is written, so what
//! waits in their buffers is still counted, and [`Progress`] knows what the client took.
//!
//! A client that stops leaves the HTTP library waiting, and a body that is not polled cannot look at
//! the clock. So the connection calls [`Exchange::check`] now and then: when time is over it drops
//! what makes the answer.

use std::{
    mem::take,
    pin::Pin,
    sync::Arc,
    task::{Context, Poll, Waker},
};

use bytes::Bytes;
use http_body::{Body as HttpBody, Frame, SizeHint};
use parking_lot::Mutex;
use strew_service::access::InUse;
use strew_service::{Budget, Held, Interrupted, Record};
use tokio::time::{Instant, Sleep, sleep_until};

use super::{
    progress::{OpenExchanges, Progress, Terms, Timed},
    report::Report,
};
use crate::{
    body::{Body, BoxError, Response, Whole},
    grpc,
    ops::dialect::{Dialect, Ending},
};

/// The most bytes of a frame of a whole document: its share of the budget comes back with each.
const FRAME: usize = 64 << 10;

pub(super) struct Exchange {
    state: Mutex<State>,
    budget: Budget,
    dialect: Dialect,
    /// Those of its connection, of which it is one until it is dropped.
    open: Arc<OpenExchanges>,
    _permits: Permits,
}

/// The places that are free again when an exchange is over.
pub(super) struct Permits {
    pub(super) _request: InUse,
    pub(super) _probe: Option<InUse>,
    pub(super) _base: Held,
}

#[derive(Clone, Copy, Debug)]
struct End {
    at: Option<Instant>,
    why: Ending,
}

struct State {
    report: Report,
    /// The most time, if the client set a limit as well.
    end: End,
    /// The body that makes the answer; none before the head, after the end, and once it was broken off.
    body: Option<Body>,
    /// The rest of a frame of a whole document.
    rest: Bytes,
    /// The share of a whole document.
    whole: Option<Arc<Held>>,
    /// Why it was broken off, until the client has been sent that.
    unreported: Option<Ending>,
    broken: Option<Instant>,
    /// Bytes that left and have not been written.
    in_flight: usize,
    progress: Progress,
    reader: Option<Waker>,
}

impl Exchange {
    pub(super) fn new(
        report: Report,
        dialect: Dialect,
        terms: Terms,
        permits: Permits,
        open: Arc<OpenExchanges>,
        now: Instant,
    ) -> Arc<Self> {
        let budget = report.record().budget().clone();
        let state = State {
            report,
            end: End {
                at: now.checked_add(terms.whole),
                why: Ending::Interrupted(Interrupted::TimeOver),
            },
            body: None,
            rest: Bytes::new(),
            whole: None,
            unreported: None,
            broken: None,
            in_flight: 0,
            progress: Progress::new(terms, now),
            reader: None,
        };
        let exchange = Arc::new(Self {
            state: Mutex::new(state),
            budget,
            dialect,
            open,
            _permits: permits,
        });
        let timed = Arc::downgrade(&exchange);
        exchange.open.begun(timed, now);
        exchange
    }

    /// The answer, of which every byte counts until the socket has taken it.
    pub(super) fn answer(self: Arc<Self>, response: &mut Response) {
        let mut state = self.state.lock();
        let deadline = response.extensions_mut().remove::<grpc::Deadline>();
        if let Some(deadline) = deadline
            && state.end.at.is_none_or(|at| deadline.end() < at)
        {
            state.end = End {
                at: Some(deadline.end()),
                why: Ending::Deadline(deadline),
            };
        }
        let end = state.end.at;
        state.report.head(response);
        let held = response.extensions_mut().remove::<Whole>();
        let body = take(response.body_mut());
        let whole = body.size_hint().exact();
        let whole = whole.and_then(|bytes| usize::try_from(bytes).ok());
        state.whole = whole.filter(|&bytes| bytes > 0).map(|bytes| match held {
            Some(Whole(held)) => held,
            None => Arc::new(self.budget.hold_anyway(bytes)),
        });
        state.body = Some(body);
        state.progress.resume(Instant::now());
        drop(state);
        *response.body_mut() = Body::new(Reply {
            exchange: self,
            end,
            sleep: None,
        });
    }

    /// The socket took bytes, or the connection is gone.
    fn written(&self, bytes: usize) {
        let now = Instant::now();
        let mut state = self.state.lock();
        state.in_flight -= bytes;
        state.progress.taken(bytes, now);
        // The reader is only set while the body has nothing to give.
        if state.in_flight == 0 && state.reader.is_some() {
            state.progress.pause(now);
        }
    }
}

impl Timed for Exchange {
    fn check(&self, now: Instant) -> Option<Instant> {
        let mut state = self.state.lock();
        let end = state.end;
        if state.broken.is_some() {
            return state.broken;
        }
        let has_begun = state.body.is_some() || state.in_flight > 0;
        let why = if has_begun && end.at.is_some_and(|at| at <= now) {
            end.why
        } else if state.progress.is_over(now) {
            Ending::Interrupted(Interrupted::Stalled)
        } else {
            return None;
        };
        state.broken = Some(now);
        let body = state.body.take();
        state.unreported = body.is_some().then_some(why);
        state.rest = Bytes::new();
        // Bytes that have left hold their share of a whole document until they are written or dropped.
        state.whole = None;
        state.report.cut(why);
        let reader = state.reader.take();
        drop(state);
        drop(body);
        if let Some(reader) = reader {
            reader.wake();
        }
        Some(now)
    }
}

impl Drop for Exchange {
    fn drop(&mut self) {
        self.open.ended();
    }
}

pub(super) struct Reply {
    exchange: Arc<Exchange>,
    end: Option<Instant>,
    /// Made when there is something to wait for.
    sleep: Option<Pin<Box<Sleep>>>,
}

impl State {
    fn leave(&mut self, exchange: &Arc<Exchange>, mut bytes: Bytes, now: Instant) -> Frame<Bytes> {
        let held = match &self.whole {
            Some(whole) => {
                if bytes.len() > FRAME {
                    self.rest = bytes.split_off(FRAME);
                }
                whole.clone()
            }
            None => Arc::new(exchange.budget.hold_anyway(bytes.len())),
        };
        self.report.part(bytes.len(), now);
        if self.rest.is_empty() && self.body.as_ref().is_some_and(Body::is_end_stream) {
            self.report.whole();
            self.whole = None;
        }
        if bytes.is_empty() {
            return Frame::data(bytes);
        }
        self.in_flight += bytes.len();
        self.progress.resume(now);
        Frame::data(Bytes::from_owner(InFlight {
            bytes,
            exchange: exchange.clone(),
            _held: held,
        }))
    }
}

impl HttpBody for Reply {
    type Data = Bytes;
    type Error = BoxError;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, BoxError>>> {
        let this = &mut *self;
        let exchange = this.exchange.clone();
        let now = Instant::now();
        if this.end.is_some_and(|at| at <= now) {
            exchange.check(now);
        }
        let mut guard = exchange.state.lock();
        let state = &mut *guard;
        state.reader = None;
        if let Some(why) = state.unreported.take() {
            return Poll::Ready(exchange.dialect.ending(why));
        }
        if !state.rest.is_empty() {
            let rest = take(&mut state.rest);
            return Poll::Ready(Some(Ok(state.leave(&exchange, rest, now))));
        }
        let Some(body) = &mut state.body else {
            return Poll::Ready(None);
        };
        let record = state.report.record().clone();
        let polled = Record::within(Some(record), || Pin::new(body).poll_frame(cx));
        match polled {
            Poll::Pending => {
                state.reader = Some(cx.waker().clone());
                if state.in_flight == 0 {
                    state.progress.pause(now);
                }
                drop(guard);
                let Some(at) = this.end else {
                    return Poll::Pending;
                };
                let sleep = this.sleep.get_or_insert_with(|| Box::pin(sleep_until(at)));
                if sleep.as_mut().poll(cx).is_ready() {
                    exchange.check(Instant::now());
                    let unreported = exchange.state.lock().unreported.take();
                    return Poll::Ready(unreported.and_then(|why| exchange.dialect.ending(why)));
                }
                Poll::Pending
            }
            Poll::Ready(None) => {
                state.report.whole();
                (state.body, state.whole) = (None, None);
                Poll::Ready(None)
            }
            Poll::Ready(Some(Err(error))) => {
                state.report.broken_off();
                Poll::Ready(Some(Err(error.into_inner())))
            }
            Poll::Ready(Some(Ok(frame))) => Poll::Ready(Some(Ok(match frame.into_data() {
                Ok(bytes) => state.leave(&exchange, bytes, now),
                Err(frame) => {
                    state.report.trailers(&frame);
                    frame
                }
            }))),
        }
    }

    fn is_end_stream(&self) -> bool {
        let state = self.exchange.state.lock();
        let is_over = state.body.as_ref().is_none_or(Body::is_end_stream);
        is_over && state.rest.is_empty() && state.unreported.is_none()
    }

    fn size_hint(&self) -> SizeHint {
        let state = self.exchange.state.lock();
        let body = state.body.as_ref().map(Body::size_hint);
        let body = body.unwrap_or_else(|| SizeHint::with_exact(0));
        let rest = state.rest.len() as u64;
        let mut hint = SizeHint::new();
        hint.set_lower(body.lower() + rest);
        if let Some(upper) = body.upper() {
            hint.set_upper(upper + rest);
        }
        hint
    }
}

impl Drop for Reply {
    /// Frees what makes the answer, also while frames of it are still to be written.
    fn drop(&mut self) {
        let mut state = self.exchange.state.lock();
        let body = state.body.take();
        (state.rest, state.whole, state.unreported) = (Bytes::new(), None, None);
        drop(state);
        drop(body);
    }
}

struct InFlight {
    bytes: Bytes,
    exchange: Arc<Exchange>,
    _held: Arc<Held>,
}

impl AsRef<[u8]> for InFlight {
    fn as_ref(&self) -> &[u8] {
        &self.bytes
    }
}

impl Drop for InFlight {
    fn drop(&mut self) {
        self.exchange.written(self.bytes.len());
    }
}
