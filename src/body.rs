//! Bodies of requests and answers: bytes that are there, or frames that come one by one.

use std::{
    fmt,
    pin::Pin,
    sync::Arc,
    task::{Context, Poll},
};

use bytes::Bytes;
use futures_util::{Stream, TryStreamExt as _};
use http_body::{Body as HttpBody, Frame, SizeHint};
use http_body_util::{BodyDataStream, BodyExt as _, Limited, StreamBody};
use hyper::body::Incoming;
use strew_service::Held;

/// An error of a body.
pub type BoxError = Box<dyn std::error::Error + Send + Sync>;

/// The pieces of a body.
pub type Pieces = BodyDataStream<Body>;

/// A request.
pub type Request = http::Request<Body>;

/// An answer.
pub type Response = http::Response<Body>;

/// An answer in the making.
pub type Answering = Pin<Box<dyn Future<Output = Response> + Send>>;

/// A body.
#[derive(Default)]
pub struct Body {
    inner: Inner,
    /// The memory of an answer that is there as a whole.
    held: Option<Arc<Held>>,
}

enum Inner {
    Bytes(Bytes),
    Incoming(Incoming),
    Frames(Pin<Box<dyn HttpBody<Data = Bytes, Error = BoxError> + Send>>),
}

impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Body").finish_non_exhaustive()
    }
}

impl Default for Inner {
    fn default() -> Self {
        Self::Bytes(Bytes::new())
    }
}

impl From<Inner> for Body {
    fn from(inner: Inner) -> Self {
        Self { inner, held: None }
    }
}

impl Body {
    /// No bytes.
    #[must_use]
    pub fn empty() -> Self {
        Self::default()
    }

    /// The body of a client's request.
    pub(crate) fn incoming(body: Incoming) -> Self {
        Inner::Incoming(body).into()
    }

    /// Frames of a body that breaks off with our own errors.
    pub(crate) fn frames(
        body: impl HttpBody<Data = Bytes, Error = BoxError> + Send + 'static,
    ) -> Self {
        Inner::Frames(Box::pin(body)).into()
    }

    /// This body, whose memory is held.
    pub(crate) fn holding(self, held: Held) -> Self {
        Self {
            held: Some(Arc::new(held)),
            ..self
        }
    }

    /// The memory that is held for it, and the body without it.
    pub(crate) fn release(self) -> (Option<Arc<Held>>, Self) {
        (self.held, self.inner.into())
    }

    /// The frames of another body.
    pub fn new<B>(body: B) -> Self
    where
        B: HttpBody<Data = Bytes> + Send + 'static,
        B::Error: Into<BoxError>,
    {
        Self::frames(body.map_err(Into::into))
    }

    /// The pieces of a stream; its length is not known.
    pub fn from_stream<S, E>(pieces: S) -> Self
    where
        S: Stream<Item = Result<Bytes, E>> + Send + 'static,
        E: Into<BoxError> + 'static,
    {
        Self::new(StreamBody::new(pieces.map_ok(Frame::data)))
    }

    /// Its pieces; trailers are left out.
    #[must_use]
    pub fn pieces(self) -> Pieces {
        self.into_data_stream()
    }

    /// All of it, if that is no more than `most` bytes.
    ///
    /// # Errors
    /// For longer ones, and those that break off.
    pub async fn whole(self, most: usize) -> Result<Bytes, BoxError> {
        match self.inner {
            Inner::Bytes(bytes) if bytes.len() <= most => Ok(bytes),
            inner => {
                let limited = Limited::new(Self::from(inner), most);
                Ok(limited.collect().await?.to_bytes())
            }
        }
    }
}

impl<T: Into<Bytes>> From<T> for Body {
    fn from(bytes: T) -> Self {
        Inner::Bytes(bytes.into()).into()
    }
}

impl HttpBody for Body {
    type Data = Bytes;
    type Error = BoxError;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, BoxError>>> {
        match &mut self.inner {
            Inner::Bytes(bytes) if bytes.is_empty() => Poll::Ready(None),
            Inner::Bytes(bytes) => Poll::Ready(Some(Ok(Frame::data(std::mem::take(bytes))))),
            Inner::Incoming(body) => Pin::new(body).poll_frame(cx).map_err(Into::into),
            Inner::Frames(body) => body.as_mut().poll_frame(cx),
        }
    }

    fn is_end_stream(&self) -> bool {
        match &self.inner {
            Inner::Bytes(bytes) => bytes.is_empty(),
            Inner::Incoming(body) => body.is_end_stream(),
            Inner::Frames(body) => body.is_end_stream(),
        }
    }

    fn size_hint(&self) -> SizeHint {
        match &self.inner {
            Inner::Bytes(bytes) => SizeHint::with_exact(bytes.len() as u64),
            Inner::Incoming(body) => body.size_hint(),
            Inner::Frames(body) => body.size_hint(),
        }
    }
}
