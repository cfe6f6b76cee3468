//! The methods of the contract: from the request of a call to its answer.
//!
//! Messages are read and written here, not by tonic's server: it would decode them on the thread that serves the
//! socket, before any limit is looked at, and copy every answer into a buffer of its own.

use std::{fmt, pin::Pin, sync::Arc};

use bytes::Bytes;
use prost::{DecodeError, Message};
use strew_service::Service;
use strew_service::access::Caller;
use tonic::Status;

use super::{
    compression,
    frames::{FrameStream, Frames},
    message::{self, Received},
    points::Points,
};
use crate::body::{Body, Request, Response};

/// A method.
pub(super) struct Method {
    pub(super) path: &'static str,
    /// The shape of its request.
    shape: usize,
    read: fn(Bytes) -> Result<Job, DecodeError>,
}

/// A request that is decoded, and waits for its caller and its effort.
type Job = Box<dyn FnOnce(Points, Caller, usize) -> Answered + Send>;
type Answered = Pin<Box<dyn Future<Output = Result<Frames, Status>> + Send>>;

// Made from the contract: `METHODS`.
include!("generated/methods.rs");

impl fmt::Debug for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.path)
    }
}

impl Method {
    /// Answers a call.
    pub(super) async fn answer(
        &self,
        service: Arc<Service>,
        caller: Caller,
        request: Request,
    ) -> Response {
        let coding = compression::asked(request.headers());
        match self.frames(service, caller, request).await {
            Ok(frames) => frames.response(coding),
            Err(status) => status.into_http(),
        }
    }

    async fn frames(
        &self,
        service: Arc<Service>,
        caller: Caller,
        request: Request,
    ) -> Result<Frames, Status> {
        // The memory of the message is held until the head of the answer.
        let (job, effort, _held) =
            message::read(&service, &caller, (self.shape, self.read), request).await?;
        job(Points::new(service), caller, effort).await
    }
}

/// Decodes the request of a method with one answer.
fn once<M, A, F>(
    bytes: Bytes,
    answer: impl FnOnce(Points, Caller, Received<M>) -> F + Send + 'static,
) -> Result<Job, DecodeError>
where
    M: Message + Default + 'static,
    A: Message,
    F: Future<Output = Result<A, Status>> + Send,
{
    let message = Box::new(M::decode(bytes)?);
    Ok(Box::new(|points, caller, effort| {
        Box::pin(async move {
            let received = Received { message, effort };
            let answered = answer(points, caller, received).await?;
            Ok(Frames::one(&answered))
        })
    }))
}

/// Decodes the request of a method with a stream of answers.
fn streamed<M, F>(
    bytes: Bytes,
    answer: impl FnOnce(Points, Caller, Received<M>) -> F + Send + 'static,
) -> Result<Job, DecodeError>
where
    M: Message + Default + 'static,
    F: Future<Output = Result<FrameStream, Status>> + Send,
{
    let message = Box::new(M::decode(bytes)?);
    Ok(Box::new(|points, caller, effort| {
        Box::pin(async move {
            let received = Received { message, effort };
            Ok(Frames::Many(answer(points, caller, received).await?))
        })
    }))
}

/// The answer to a method that does not exist.
#[must_use]
pub fn unimplemented() -> Response {
    let methods: Vec<&str> = METHODS.iter().map(|method| method.path).collect();
    let methods = methods.join(", ");
    Status::unimplemented(format!("unknown method; available: {methods}")).into_http::<Body>()
}
