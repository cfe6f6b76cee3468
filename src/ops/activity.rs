//! What a connection is doing: requests under way, and whether anything happens at all.

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
    /// Under way: from their head to the end of their answer.
    open: AtomicUsize,
    /// So many have begun.
    begun: AtomicU64,
}

impl Activity {
    /// A request begins.
    pub(super) fn begin(self: &Arc<Self>) -> Request {
        self.open.fetch_add(1, Ordering::Relaxed);
        self.begun.fetch_add(1, Ordering::Relaxed);
        Request {
            activity: self.clone(),
        }
    }

    /// Waits until there has been no request for so long, or up to twice as long.
    pub(super) async fn idle(&self, patience: Duration) {
        loop {
            let begun = self.begun.load(Ordering::Relaxed);
            tokio::time::sleep(patience).await;
            let is_idle = self.open.load(Ordering::Relaxed) == 0;
            if is_idle && begun == self.begun.load(Ordering::Relaxed) {
                return;
            }
        }
    }
}

/// A request under way, until dropped.
#[derive(Debug)]
pub(super) struct Request {
    activity: Arc<Activity>,
}

impl Drop for Request {
    fn drop(&mut self) {
        self.activity.open.fetch_sub(1, Ordering::Relaxed);
    }
}

/// The body of an answer: as long as there is one, its request is under way.
#[derive(Debug)]
pub(super) struct Answering<B> {
    body: B,
    _request: Request,
}

impl<B> Answering<B> {
    pub(super) const fn new(body: B, request: Request) -> Self {
        Self {
            body,
            _request: request,
        }
    }
}

impl<B: Body + Unpin> Body for Answering<B> {
    type Data = B::Data;
    type Error = B::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<B::Data>, B::Error>>> {
        Pin::new(&mut self.body).poll_frame(cx)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}
