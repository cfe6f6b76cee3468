//! Answers whose messages are framed where they are made, on the workers.
//!
//! tonic would copy every message into a buffer of its own, new for each, on the thread that serves
//! the socket. A block of points is as long as all the rest of its message is short, so blocks are
//! made with room around them, tags and prefix are written into it, and the buffer goes to the
//! socket as it is. Calls that ask for compression go through tonic.

use std::{
    convert::Infallible,
    fmt,
    pin::Pin,
    sync::{Arc, Mutex, PoisonError},
    task::{Context, Poll},
};

use bytes::Bytes;
use futures_util::Stream;
use http::{HeaderMap, Request, Response};
use http_body::Frame;
use prost::Message;
use tonic::{Status, body::Body, codegen::Service, server::NamedService};

use super::message;

/// What stands before a message on the wire: whether it is compressed, and its length.
pub(super) const PREFIX: usize = 5;

/// The prefix of a message that is not compressed. (Messages are about as long as a block, which
/// configuration keeps far below 4 GiB.)
pub(super) fn prefix(length: usize) -> [u8; PREFIX] {
    let [a, b, c, d] = u32::try_from(length).unwrap_or(u32::MAX).to_be_bytes();
    [0, a, b, c, d]
}

/// A message with its prefix.
pub(super) fn framed(message: &impl Message) -> Bytes {
    let length = message.encoded_len();
    let mut frame = Vec::with_capacity(PREFIX + length);
    frame.extend_from_slice(&prefix(length));
    message.encode_raw(&mut frame);
    frame.into()
}

type FrameStream = Pin<Box<dyn Stream<Item = Result<Bytes, Status>> + Send>>;

/// Framed messages, which an answer carries past tonic to [`Direct`].
#[derive(Clone)]
pub(super) struct Frames(Arc<Mutex<Option<FrameStream>>>);

impl Frames {
    pub(super) fn new(frames: impl Stream<Item = Result<Bytes, Status>> + Send + 'static) -> Self {
        Self(Arc::new(Mutex::new(Some(Box::pin(frames)))))
    }

    fn take(&self) -> Option<FrameStream> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl fmt::Debug for Frames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Frames")
    }
}

/// A service whose requests come with their message decoded (`message`), and whose answers may carry
/// [`Frames`]: then these are the body.
#[derive(Clone, Debug)]
pub(super) struct Direct<S> {
    pub(super) inner: S,
    pub(super) service: Arc<crate::service::Service>,
}

impl<S: NamedService> NamedService for Direct<S> {
    const NAME: &'static str = S::NAME;
}

type Answer = Pin<Box<dyn Future<Output = Result<Response<Body>, Infallible>> + Send>>;

impl<S> Service<Request<Body>> for Direct<S>
where
    S: Service<Request<Body>, Response = Response<Body>, Error = Infallible>,
    S: Clone + Send + 'static,
    S::Future: Send + 'static,
{
    type Response = Response<Body>;
    type Error = Infallible;
    type Future = Answer;

    fn poll_ready(&mut self, cx: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        self.inner.poll_ready(cx)
    }

    fn call(&mut self, request: Request<Body>) -> Answer {
        // Generated services are always ready.
        let Self { mut inner, service } = self.clone();
        Box::pin(async move {
            // What the message takes is held until the head of the answer.
            let (request, _held) = match message::read(&service, request).await {
                Ok(read) => read,
                Err(refused) => return Ok(refused.into_http()),
            };
            let mut answer = inner.call(request).await?;
            let frames = answer.extensions_mut().remove::<Frames>();
            if let Some(frames) = frames.and_then(|frames| frames.take()) {
                *answer.body_mut() = Body::new(Framed(Some(frames)));
            }
            Ok(answer)
        })
    }
}

/// Frames, then the status.
struct Framed(Option<FrameStream>);

impl http_body::Body for Framed {
    type Data = Bytes;
    type Error = Status;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Status>>> {
        let Some(frames) = &mut self.0 else {
            return Poll::Ready(None);
        };
        let status = match frames.as_mut().poll_next(cx) {
            Poll::Pending => return Poll::Pending,
            Poll::Ready(Some(Ok(frame))) => return Poll::Ready(Some(Ok(Frame::data(frame)))),
            Poll::Ready(Some(Err(status))) => status,
            Poll::Ready(None) => Status::ok(""),
        };
        self.0 = None;
        let mut trailers = HeaderMap::new();
        let told = status.add_header(&mut trailers);
        Poll::Ready(Some(told.map(|()| Frame::trailers(trailers))))
    }

    fn is_end_stream(&self) -> bool {
        self.0.is_none()
    }
}
