//! What a connection is doing: requests under way, and whether anything moves at all.

use std::{
    pin::Pin,
    sync::{
        Arc,
        atomic::{AtomicU64, AtomicUsize, Ordering},
    },
    task::{Context, Poll},
    time::Duration,
};

use http_body::{Body, Frame, SizeHint};

/// The requests of one connection.
#[derive(Debug, Default)]
pub(super) struct Activity {
    /// Requests under way: from their head to the end of their answer.
    open: AtomicUsize,
    /// Those of them for which we have something to do, and not the client.
    ours: AtomicUsize,
    /// So many things have happened.
    moves: AtomicU64,
}

/// Why a connection may end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Still {
    /// There has been no request for long.
    Idle,
    /// Answers wait for a client that takes nothing of any.
    Stalled,
}

impl Activity {
    /// A request begins.
    pub(super) fn begin(self: &Arc<Self>) -> Request {
        self.open.fetch_add(1, Ordering::Relaxed);
        let mut request = Request {
            activity: self.clone(),
            is_ours: false,
        };
        request.turn(true);
        request
    }

    /// Waits until nothing has moved for long: so long without a request, or so long with answers that
    /// nobody takes.
    pub(super) async fn still(&self, idle: Duration, stalled: Duration) -> Still {
        let step = idle.min(stalled);
        let mut seen = self.moves.load(Ordering::Relaxed);
        let mut quiet = Duration::ZERO;
        loop {
            tokio::time::sleep(step).await;
            let moves = self.moves.load(Ordering::Relaxed);
            if moves != seen || self.ours.load(Ordering::Relaxed) > 0 {
                (seen, quiet) = (moves, Duration::ZERO);
                continue;
            }
            quiet = quiet.saturating_add(step);
            let is_open = self.open.load(Ordering::Relaxed) > 0;
            if is_open && quiet >= stalled {
                return Still::Stalled;
            }
            if !is_open && quiet >= idle {
                return Still::Idle;
            }
        }
    }
}

/// A request under way, until dropped.
#[derive(Debug)]
pub(super) struct Request {
    activity: Arc<Activity>,
    is_ours: bool,
}

impl Request {
    /// Something happened: now it is our turn, or the client's.
    fn turn(&mut self, is_ours: bool) {
        let activity = &*self.activity;
        match (self.is_ours, is_ours) {
            (false, true) => activity.ours.fetch_add(1, Ordering::Relaxed),
            (true, false) => activity.ours.fetch_sub(1, Ordering::Relaxed),
            _ => 0,
        };
        self.is_ours = is_ours;
        activity.moves.fetch_add(1, Ordering::Relaxed);
    }
}

impl Drop for Request {
    fn drop(&mut self) {
        self.turn(false);
        self.activity.open.fetch_sub(1, Ordering::Relaxed);
    }
}

/// The body of an answer: as long as there is one, its request is under way.
#[derive(Debug)]
pub(super) struct Answering<B> {
    body: B,
    request: Request,
}

impl<B> Answering<B> {
    pub(super) fn new(body: B, mut request: Request) -> Self {
        request.turn(false);
        Self { body, request }
    }
}

impl<B: Body + Unpin> Body for Answering<B> {
    type Data = B::Data;
    type Error = B::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<B::Data>, B::Error>>> {
        let polled = Pin::new(&mut self.body).poll_frame(cx);
        self.request.turn(polled.is_pending());
        polled
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    #[tokio::test(start_paused = true)]
    async fn what_is_ours_to_do_is_never_still() {
        let activity = Arc::new(Activity::default());
        let wait = || activity.still(10 * SECOND, SECOND);
        assert_eq!(wait().await, Still::Idle);
        let request = activity.begin();
        let waited = tokio::time::timeout(100 * SECOND, wait()).await;
        assert!(waited.is_err(), "the answer is being made");
        let answer = Answering::new(axum::body::Body::from("answer"), request);
        assert_eq!(wait().await, Still::Stalled);
        drop(answer);
        assert_eq!(wait().await, Still::Idle);
    }
}
