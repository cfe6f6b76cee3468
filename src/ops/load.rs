//! What is taken on, before each door: so many requests at once, so many bytes, and so long for each step.
//!
//! A request is under way from its head to the head of its answer. In that time its body must come and
//! its answer must be found; who takes longer is told so, and what was being done for it stops. Then
//! the answer is on its own way, which [`timed`](super::timed) bounds. Probes are always let through.

use std::{
    error::Error as StdError,
    pin::Pin,
    sync::{Arc, Mutex, PoisonError},
    task::{Context, Poll},
    time::Duration,
};

use axum::{
    Router,
    body::Body,
    extract::{Request, State},
    middleware::{self, Next},
    response::Response,
};
use bytes::Bytes;
use http_body::{Body as HttpBody, Frame, SizeHint};
use tokio::{
    sync::{Notify, Semaphore},
    time::{Sleep, sleep},
};

use super::{
    often::Often,
    timed::{Ending, Terms, Timed},
};
use crate::{
    config::{Config, seconds},
    service::{Budget, Error, Held, Service},
};

/// What all doors share. Cheap to clone.
#[derive(Clone, Debug)]
pub(super) struct Load {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    places: Semaphore,
    limit: usize,
    budget: Arc<Budget>,
    body: Duration,
    first_byte: Duration,
    answer: Terms,
    refused: Often,
}

/// How a door says no.
#[derive(Clone, Copy, Debug)]
pub(super) struct Words {
    /// A whole answer.
    pub(super) refusal: fn(&Error) -> Response,
    /// What the door's reader of bodies finds instead of more.
    pub(super) broken: fn(Error) -> BoxError,
    /// The end of an answer that is not complete.
    pub(super) ending: Ending,
}

pub(super) type BoxError = Box<dyn StdError + Send + Sync>;

/// The paths of those who watch over us: they are to hear from us when others cannot.
const PROBES: [&str; 4] = ["/livez", "/readyz", "/metrics", "/grpc.health.v1.Health/"];

impl Load {
    pub(super) fn new(config: &Config, service: &Service) -> Self {
        let (server, limit) = (&config.server, config.limits.max_requests);
        Self {
            shared: Arc::new(Shared {
                places: Semaphore::new(limit),
                limit,
                budget: service.budget().clone(),
                body: seconds(server.body_read_timeout_seconds),
                first_byte: seconds(server.first_byte_seconds),
                answer: Terms {
                    stalled: seconds(server.stalled_reader_seconds),
                    whole: seconds(server.max_stream_seconds),
                },
                refused: Often::default(),
            }),
        }
    }

    /// Puts these bounds before a door.
    pub(super) fn before(&self, door: Router, words: Words) -> Router {
        door.layer(middleware::from_fn_with_state((self.clone(), words), pass))
    }
}

async fn pass(
    State((load, words)): State<(Load, Words)>,
    request: Request,
    next: Next,
) -> Response {
    let path = request.uri().path();
    if PROBES.iter().any(|probe| path.starts_with(probe)) {
        return next.run(request).await;
    }
    let shared = &*load.shared;
    match shared.answer(words, request, next).await {
        Ok(answer) => answer,
        Err(error) => {
            if let Some(times) = shared.refused.once_more() {
                tracing::warn!(%error, times, "a request is refused");
            }
            (words.refusal)(&error)
        }
    }
}

impl Shared {
    async fn answer(&self, words: Words, request: Request, next: Next) -> Result<Response, Error> {
        let limit = self.limit;
        let place = self.places.try_acquire();
        let place = place.map_err(|_| Error::TooManyRequests { limit })?;
        let received = Arc::new(Receiving {
            held: Mutex::new(self.budget.hold(0)?),
            done: Notify::new(),
        });
        let request = request.map(|body| {
            if body.is_end_stream() {
                received.done.notify_one();
                return body;
            }
            Body::new(Received {
                body,
                deadline: Box::pin(sleep(self.body)),
                patience: self.body,
                receiving: received.clone(),
                broken: words.broken,
            })
        });
        // The body has a deadline of its own; the time for the answer begins when it is there.
        let too_long = async {
            received.done.notified().await;
            sleep(self.first_byte).await;
        };
        let response = tokio::select! {
            response = next.run(request) => response,
            () = too_long => {
                let seconds = self.first_byte.as_secs_f64();
                return Err(Error::TimeOver { seconds: seconds.to_string() });
            }
        };
        drop((place, received));
        let whole = response.body().size_hint().exact();
        Ok(match whole {
            Some(0) => response,
            Some(bytes) => {
                let held = self
                    .budget
                    .hold(usize::try_from(bytes).unwrap_or(usize::MAX))?;
                response.map(|body| Body::new(Whole { body, _held: held }))
            }
            None => response.map(|body| Body::new(Timed::new(body, self.answer, words.ending))),
        })
    }
}

/// A body that is being received.
#[derive(Debug)]
struct Receiving {
    /// What has come of it: it is kept until there is an answer.
    held: Mutex<Held>,
    /// Told when the last of it has come, or is not wanted any more.
    done: Notify,
}

/// The body of a request: in time, and within the budget.
struct Received {
    body: Body,
    deadline: Pin<Box<Sleep>>,
    patience: Duration,
    receiving: Arc<Receiving>,
    broken: fn(Error) -> BoxError,
}

impl HttpBody for Received {
    type Data = Bytes;
    type Error = BoxError;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, BoxError>>> {
        let polled = Pin::new(&mut self.body).poll_frame(cx);
        let fault = match &polled {
            Poll::Ready(Some(Ok(frame))) => {
                let bytes = frame.data_ref().map_or(0, Bytes::len);
                let held = self.receiving.held.lock();
                held.unwrap_or_else(PoisonError::into_inner)
                    .more(bytes)
                    .err()
            }
            Poll::Ready(_) => None,
            Poll::Pending => {
                let is_over = self.deadline.as_mut().poll(cx).is_ready();
                let seconds = self.patience.as_secs_f64().to_string();
                is_over.then_some(Error::BodyTooSlow { seconds })
            }
        };
        match fault {
            Some(fault) => Poll::Ready(Some(Err((self.broken)(fault)))),
            None => polled.map_err(Into::into),
        }
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

impl Drop for Received {
    fn drop(&mut self) {
        self.receiving.done.notify_one();
    }
}

/// An answer that is there, and what it takes.
struct Whole {
    body: Body,
    _held: Held,
}

impl HttpBody for Whole {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        Pin::new(&mut self.body).poll_frame(cx)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}
