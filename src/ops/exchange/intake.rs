//! The limits on requests that are taken on: the number at once, the bytes of their bodies, and the time for each
//! step to the head of the answer.
//!
//! A body must arrive in time; what arrives takes bytes of the budget and no place. From the end of its body to the
//! head of its answer a request has a place. There it waits for its turns and is worked on, each no longer than
//! the settings allow; a request that takes longer is refused, and the work for it stops. Health checks have
//! places of their own.

use std::{
    future::ready,
    mem::take,
    pin::Pin,
    sync::Arc,
    task::{Context, Poll},
    time::Duration,
};

use bytes::Bytes;
use http_body::{Body as HttpBody, Frame, SizeHint};
use parking_lot::Mutex;
use strew_config::{Config, seconds};
use strew_error::Error;
use strew_service::access::{InUse, OneOf, Quota, Usage};
use strew_service::{Budget, Held, Record};
use tokio::{
    sync::Notify,
    time::{Instant, Sleep, sleep, sleep_until},
};

use super::Inbound;
use crate::{
    body::{Body, BoxError, Response, Whole},
    ops::{
        dialect::Dialect,
        step::{Next, Step},
        telemetry::LogThrottle,
    },
};

/// The bounds that all requests share. Cheap to clone.
#[derive(Clone)]
pub(in crate::ops) struct Intake(Arc<Bounds>);

struct Bounds {
    places: Arc<Quota>,
    budget: Budget,
    body: Duration,
    first_byte: Duration,
    refused: LogThrottle,
}

impl Intake {
    pub(in crate::ops) fn new(config: &Config, budget: Budget) -> Self {
        Self(Arc::new(Bounds {
            places: Arc::new(Quota::new(config.limits.max_requests)),
            budget,
            body: seconds(config.server.body_read_timeout_seconds),
            first_byte: seconds(config.server.first_byte_seconds),
            refused: LogThrottle::default(),
        }))
    }
}

impl Step<Inbound> for Intake {
    async fn answer(&self, mut inbound: Box<Inbound>, next: &impl Next<Inbound>) -> Response {
        let (bounds, dialect) = (&*self.0, inbound.client.dialect);
        let answered = match inbound.refused.take() {
            Some(error) => Err(error),
            None => bounds.answer(inbound, next).await,
        };
        answered.unwrap_or_else(|error| {
            if let Some(times) = bounds.refused.record() {
                tracing::warn!(%error, times, "a request is refused");
            }
            dialect.refusal(&error)
        })
    }
}

impl Bounds {
    async fn answer(
        &self,
        mut inbound: Box<Inbound>,
        next: &impl Next<Inbound>,
    ) -> Result<Response, Error> {
        let client = &inbound.client;
        let (dialect, is_probe) = (client.dialect, client.is_probe);
        let permits = (!is_probe).then(|| Permits {
            all: self.places.clone(),
            address: client.usage.clone(),
        });
        let record = Record::current();
        let budget = record
            .as_ref()
            .map_or(&self.budget, |record| record.budget());
        let mut response = if inbound.request.body().is_end_stream() {
            let _permit = permits.as_ref().map(Permits::take).transpose()?;
            self.in_time(record.as_deref(), ready(()), next.answer(inbound))
                .await?
        } else {
            let received = Arc::new(Receiving {
                held: Mutex::new(budget.hold_anyway(0)),
                permit: Mutex::new(None),
                permits,
                done: Notify::new(),
            });
            inbound.request = take(&mut inbound.request).map(|body| {
                Body::new(LimitedBody {
                    body,
                    deadline: Box::pin(sleep(self.body)),
                    patience: self.body,
                    receiving: received.clone(),
                    dialect,
                    at_once: 0,
                    free: if is_probe { PROBE_BODY } else { 0 },
                })
            });
            let is_received = received.done.notified();
            self.in_time(record.as_deref(), is_received, next.answer(inbound))
                .await?
        };
        let whole = response.body().size_hint().exact();
        if let Some(bytes @ 1..) = whole {
            let bytes = usize::try_from(bytes).unwrap_or(usize::MAX);
            let held = match is_probe {
                true => budget.hold_anyway(bytes),
                false => budget.hold(bytes)?,
            };
            Whole::hold(&mut response, held);
        }
        Ok(response)
    }

    /// Answers in time. A body has a deadline of its own: the time begins when it is there. Waiting for turns and work
    /// each have as long as the settings allow.
    async fn in_time(
        &self,
        record: Option<&Record>,
        is_received: impl Future<Output = ()>,
        answer: impl Future<Output = Response>,
    ) -> Result<Response, Error> {
        let too_long = async {
            is_received.await;
            let begun = Instant::now();
            let mut waited = Duration::ZERO;
            while waited < self.first_byte && begun.elapsed() < self.first_byte + waited {
                sleep_until(begun + self.first_byte + waited).await;
                let clock = record.map(|record| record.clock().waited());
                waited = clock.unwrap_or_default();
            }
            let seconds = self.first_byte.as_secs_f64().to_string();
            match record.is_some_and(Record::come_back) {
                true => Error::KindsInTheMaking { seconds },
                false => Error::TimeOver { seconds },
            }
        };
        tokio::select! {
            // An answer that is there at once needs no timer.
            biased;
            response = answer => Ok(response),
            error = too_long => Err(error),
        }
    }
}

struct Receiving {
    /// The memory of the body so far, held until there is an answer.
    held: Mutex<Held>,
    /// The place of the request, once all of it has come.
    permit: Mutex<Option<Permit>>,
    /// Where it takes its place; health checks need none.
    permits: Option<Permits>,
    /// Notified when the last of it has come, or is not wanted any more.
    done: Notify,
}

struct Permits {
    all: Arc<Quota>,
    address: Arc<Usage>,
}

/// A place among all requests, and one among those of the address.
type Permit = (OneOf, InUse);

impl Permits {
    fn take(&self) -> Result<Permit, Error> {
        let limit = self.all.limit();
        let of_address = self.address.place(&self.all)?;
        let one = self.all.clone().one();
        Ok((one.ok_or(Error::TooManyRequests { limit })?, of_address))
    }
}

impl Receiving {
    fn take_permit(&self) -> Result<(), Error> {
        let Some(permits) = &self.permits else {
            return Ok(());
        };
        let mut permit = self.permit.lock();
        if permit.is_none() {
            *permit = Some(permits.take()?);
        }
        Ok(())
    }
}

/// The bytes that are read before other requests have their turn: clients that send fast would keep the
/// thread.
const AT_ONCE: usize = 64 << 10;
/// The bytes of a health check that are taken although the budget is used up: it names a service.
const PROBE_BODY: usize = 1 << 10;

struct LimitedBody {
    body: Body,
    deadline: Pin<Box<Sleep>>,
    patience: Duration,
    receiving: Arc<Receiving>,
    dialect: Dialect,
    /// The bytes that were read since the reader last waited.
    at_once: usize,
    free: usize,
}

impl HttpBody for LimitedBody {
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
                self.receiving.held.lock().grow(counted).err()
            }
            Poll::Ready(None) => self.receiving.take_permit().err(),
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
            None => polled.map_err(|error| self.dialect.unreadable(error.into_inner())),
        }
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

impl Drop for LimitedBody {
    fn drop(&mut self) {
        // A body that is not read to its end counts as well, where there is a place.
        let _ = self.receiving.take_permit();
        self.receiving.done.notify_one();
    }
}
