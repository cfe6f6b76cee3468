//! Answers that do not stay forever: what a reader leaves untouched is taken away, and so is what takes
//! longer than answers may.
//!
//! A reader that stops leaves the HTTP library waiting, and a body that is not asked for cannot look
//! at the clock. So a task of its own does: when time is over it drops what makes the answer, which
//! gives back its place and its memory, and the reader finds a broken stream whenever it comes back.

use std::{
    pin::Pin,
    sync::{Arc, Mutex, MutexGuard, PoisonError, Weak},
    task::{Context, Poll, Waker},
    time::Duration,
};

use axum::{Error, body::Body};
use bytes::Bytes;
use http_body::{Body as HttpBody, Frame, SizeHint};
use tokio::{
    task::AbortHandle,
    time::{Instant, sleep_until},
};

use crate::service::Interrupted;

/// How an answer says that it is not complete.
pub(super) type Ending = fn(Interrupted) -> Option<Result<Frame<Bytes>, Error>>;

/// How long an answer may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms {
    /// How long its reader may take nothing.
    pub(super) stalled: Duration,
    /// How long it may take in all.
    pub(super) whole: Duration,
}

/// An answer with an end in time.
#[derive(Debug)]
pub(super) struct Timed {
    shared: Arc<Mutex<Shared>>,
    ending: Ending,
    watch: AbortHandle,
}

#[derive(Debug)]
struct Shared {
    /// Nothing once time was over.
    body: Option<Body>,
    /// Why it was, until the reader has been told.
    over: Option<Interrupted>,
    /// When the reader took something last.
    taken: Instant,
    /// Whether the reader waits for us, and not we for it.
    is_awaited: bool,
    reader: Option<Waker>,
}

impl Timed {
    pub(super) fn new(body: Body, terms: Terms, ending: Ending) -> Self {
        let now = Instant::now();
        let shared = Arc::new(Mutex::new(Shared {
            body: Some(body),
            over: None,
            taken: now,
            is_awaited: false,
            reader: None,
        }));
        let watch = tokio::spawn(watch(Arc::downgrade(&shared), terms, now));
        Self {
            shared,
            ending,
            watch: watch.abort_handle(),
        }
    }

    fn shared(&self) -> MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Ends an answer when it is time.
async fn watch(shared: Weak<Mutex<Shared>>, terms: Terms, start: Instant) {
    let far = |from: Instant, by: Duration| from.checked_add(by);
    let end = far(start, terms.whole);
    let mut from = start;
    loop {
        let stalled = far(from, terms.stalled);
        let Some(next) = stalled.into_iter().chain(end).min() else {
            return;
        };
        sleep_until(next).await;
        let Some(shared) = shared.upgrade() else {
            return;
        };
        let mut state = shared.lock().unwrap_or_else(PoisonError::into_inner);
        let now = Instant::now();
        from = if state.is_awaited { now } else { state.taken };
        let is_stalled = far(from, terms.stalled).is_some_and(|at| at <= now);
        let why = if end.is_some_and(|end| end <= now) {
            Interrupted::TimeOver
        } else if is_stalled {
            Interrupted::Stalled
        } else {
            continue;
        };
        let body = state.body.take();
        state.over = body.is_some().then_some(why);
        let reader = state.reader.take();
        drop(state);
        drop(body);
        if let Some(reader) = reader {
            reader.wake();
        }
        return;
    }
}

impl HttpBody for Timed {
    type Data = Bytes;
    type Error = Error;

    fn poll_frame(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Error>>> {
        let mut state = self.shared();
        if let Some(why) = state.over.take() {
            return Poll::Ready((self.ending)(why));
        }
        let Some(body) = &mut state.body else {
            return Poll::Ready(None);
        };
        let polled = Pin::new(body).poll_frame(cx);
        state.is_awaited = polled.is_pending();
        if state.is_awaited {
            state.reader = Some(cx.waker().clone());
        } else {
            state.taken = Instant::now();
        }
        polled
    }

    fn is_end_stream(&self) -> bool {
        let state = self.shared();
        state.over.is_none() && state.body.as_ref().is_none_or(Body::is_end_stream)
    }

    fn size_hint(&self) -> SizeHint {
        let state = self.shared();
        let hint = state.body.as_ref().map(Body::size_hint);
        hint.unwrap_or_default()
    }
}

impl Drop for Timed {
    fn drop(&mut self) {
        self.watch.abort();
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use futures_util::{StreamExt as _, stream};

    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn timed(body: Body, stalled: u32, whole: u32) -> axum::body::BodyDataStream {
        let terms = Terms {
            stalled: SECOND * stalled,
            whole: SECOND * whole,
        };
        let ending: Ending = |why| Some(Err(Error::new(why)));
        Body::new(Timed::new(body, terms, ending)).into_data_stream()
    }

    fn endless() -> Body {
        let blocks = stream::repeat_with(|| Ok::<_, Infallible>(Bytes::from_static(b"block")));
        Body::from_stream(blocks)
    }

    fn why(item: Option<Result<Bytes, Error>>) -> String {
        item.expect("not an end")
            .expect_err("not a block")
            .to_string()
    }

    #[tokio::test(start_paused = true)]
    async fn a_reader_that_takes_something_in_time_goes_on() {
        let mut body = timed(endless(), 10, 1000);
        for _ in 0..20 {
            tokio::time::sleep(9 * SECOND).await;
            body.next().await.expect("more").expect("whole");
        }
        tokio::time::sleep(21 * SECOND).await;
        assert_eq!(why(body.next().await), Interrupted::Stalled.to_string());
        assert!(body.next().await.is_none());
    }

    #[tokio::test(start_paused = true)]
    async fn what_is_left_untouched_is_dropped_at_once() {
        let held = Arc::new(());
        let kept = held.clone();
        let blocks = stream::repeat_with(move || {
            let _ = &kept;
            Ok::<_, Infallible>(Bytes::from_static(b"block"))
        });
        let mut body = timed(Body::from_stream(blocks), 10, 1000);
        body.next().await.expect("more").expect("whole");
        tokio::time::sleep(9 * SECOND).await;
        assert_eq!(Arc::strong_count(&held), 2);
        tokio::time::sleep(2 * SECOND).await;
        assert_eq!(Arc::strong_count(&held), 1);
    }

    #[tokio::test(start_paused = true)]
    async fn a_reader_that_waits_for_us_is_not_at_fault_but_has_an_end_too() {
        let never = stream::pending::<Result<Bytes, Infallible>>();
        let mut body = timed(Body::from_stream(never), 10, 100);
        let start = Instant::now();
        assert_eq!(why(body.next().await), Interrupted::TimeOver.to_string());
        assert_eq!(start.elapsed().as_secs(), 100);
    }
}
