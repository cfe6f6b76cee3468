//! Answers whose messages are framed where they are made, on the workers.
//!
//! tonic would copy every message into a buffer of its own, new for each, on the thread that serves
//! the socket. A block of points is as long as all the rest of its message is short, so blocks are
//! made with room around them, tags and prefix are written into it, and the buffer goes to the
//! socket as it is. Calls that ask for compression go through tonic.

use std::{
    fmt,
    pin::Pin,
    sync::Arc,
    task::{Context, Poll},
};

use bytes::Bytes;
use futures_util::Stream;
use http::HeaderMap;
use http_body::Frame;
use parking_lot::Mutex;
use prost::Message;
use tonic::{Status, body::Body};

/// The length of the prefix of a message on the wire: whether it is compressed, and its length.
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

/// Framed messages, which an answer carries past tonic (`direct.rs`).
#[derive(Clone)]
pub(super) struct Frames(Arc<Mutex<Option<FrameStream>>>);

impl Frames {
    pub(super) fn new(frames: impl Stream<Item = Result<Bytes, Status>> + Send + 'static) -> Self {
        Self(Arc::new(Mutex::new(Some(Box::pin(frames)))))
    }

    /// The body of these frames, which can be taken once.
    pub(super) fn body(&self) -> Option<Body> {
        let frames = self.0.lock().take();
        Some(Body::new(Framed(Some(frames?))))
    }
}

impl fmt::Debug for Frames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Frames")
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
