//! What is taken on: the number of requests at once, the bytes of their bodies, and the time for each
//! step to the head of the answer.
//!
//! A request is in progress from its head to the head of its answer. In that time its body must
//! arrive and its answer must be found; a request that takes longer is refused, and the work for it
//! stops. Health checks have places of their own.

use std::{
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

use super::{Probe, Refused};
use crate::{
    config::{Config, seconds},
    ops::{
        dialect::{BoxError, Dialect},
        throttle::LogThrottle,
    },
    service::{Budget, Error, Held, Record},
};

/// The bounds that all requests share. Cheap to clone.
#[derive(Clone, Debug)]
pub(in crate::ops) struct Intake {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    places: Semaphore,
    limit: usize,
    budget: Budget,
    body: Duration,
    first_byte: Duration,
    refused: LogThrottle,
}

impl Intake {
    pub(in crate::ops) fn new(config: &Config, budget: Budget) -> Self {
        let (server, limit) = (&config.server, config.limits.max_requests);
        Self {
            shared: Arc::new(Shared {
                places: Semaphore::new(limit),
                limit,
                budget,
                body: seconds(server.body_read_timeout_seconds),
                first_byte: seconds(server.first_byte_seconds),
                refused: LogThrottle::default(),
            }),
        }
    }

    /// Puts these bounds before a router.
    pub(in crate::ops) fn before(&self, router: Router) -> Router {
        router.layer(middleware::from_fn_with_state(self.clone(), pass))
    }
}

async fn pass(State(intake): State<Intake>, mut request: Request, next: Next) -> Response {
    let shared = &*intake.shared;
    let dialect = Dialect::of(request.headers());
    let refused = request.extensions_mut().remove::<Refused>();
    let answer = match refused {
        Some(Refused(error)) => Err(error),
        None => shared.answer(dialect, request, next).await,
    };
    answer.unwrap_or_else(|error| {
        if let Some(times) = shared.refused.record() {
            tracing::warn!(%error, times, "a request is refused");
        }
        dialect.refusal(&error)
    })
}

impl Shared {
    async fn answer(
        &self,
        dialect: Dialect,
        request: Request,
        next: Next,
    ) -> Result<Response, Error> {
        let limit = self.limit;
        let is_probe = request.extensions().get::<Probe>().is_some();
        let place = match is_probe {
            true => None,
            false => {
                let place = self.places.try_acquire();
                Some(place.map_err(|_| Error::TooManyRequests { limit })?)
            }
        };
        let record = Record::current();
        let budget = record
            .as_ref()
            .map_or(&self.budget, |record| record.budget());
        let received = Arc::new(Receiving {
            held: Mutex::new(budget.hold_anyway(0)),
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
                dialect,
                at_once: 0,
                free: if is_probe { PROBE_BODY } else { 0 },
            })
        });
        // The body has a deadline of its own; the time for the answer begins when it is there.
        let too_long = async {
            received.done.notified().await;
            sleep(self.first_byte).await;
            let seconds = self.first_byte.as_secs_f64().to_string();
            match record.as_ref().is_some_and(|record| record.is_making()) {
                true => Error::KindsInTheMaking { seconds },
                false => Error::TimeOver { seconds },
            }
        };
        let mut response = tokio::select! {
            response = next.run(request) => response,
            error = too_long => return Err(error),
        };
        drop((place, received));
        let whole = response.body().size_hint().exact();
        if let Some(bytes @ 1..) = whole {
            let bytes = usize::try_from(bytes).unwrap_or(usize::MAX);
            let held = match is_probe {
                true => budget.hold_anyway(bytes),
                false => budget.hold(bytes)?,
            };
            response.extensions_mut().insert(Arc::new(held));
        }
        Ok(response)
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

/// As much is read before other requests have their turn: clients that send fast would keep the
/// thread.
const AT_ONCE: usize = 64 << 10;
/// The bytes of a health check that are taken although the budget is used up: it names a service.
const PROBE_BODY: usize = 1 << 10;

/// The body of a request: in time, and within the budget.
struct Received {
    body: Body,
    deadline: Pin<Box<Sleep>>,
    patience: Duration,
    receiving: Arc<Receiving>,
    dialect: Dialect,
    /// The bytes that were read since the reader last waited.
    at_once: usize,
    /// The bytes that do not count.
    free: usize,
}

impl HttpBody for Received {
    type Data = Bytes;
    type Error = BoxError;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, BoxError>>> {
        if self.at_once >= AT_ONCE {
            self.at_once = 0;
            cx.waker().wake_by_ref();
            return Poll::Pending;
        }
        let polled = Pin::new(&mut self.body).poll_frame(cx);
        let fault = match &polled {
            Poll::Ready(Some(Ok(frame))) => {
                let bytes = frame.data_ref().map_or(0, Bytes::len);
                self.at_once += bytes;
                let counted = bytes.saturating_sub(self.free);
                self.free -= bytes - counted;
                let held = self.receiving.held.lock();
                held.unwrap_or_else(PoisonError::into_inner)
                    .grow(counted)
                    .err()
            }
            Poll::Ready(_) => None,
            Poll::Pending => {
                self.at_once = 0;
                let is_over = self.deadline.as_mut().poll(cx).is_ready();
                let seconds = self.patience.as_secs_f64().to_string();
                is_over.then_some(Error::BodyTooSlow { seconds })
            }
        };
        match fault {
            Some(fault) => Poll::Ready(Some(Err(self.dialect.broken(fault)))),
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
