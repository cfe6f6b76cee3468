//! Answers to calls of the contract: messages that are framed where they are made.
//!
//! A block of points is as long as all the rest of its message is short, so blocks are made with room around them on
//! the workers, tags and prefix are written into it, and the buffer goes to the socket as it is.

use std::{
    mem::take,
    pin::Pin,
    task::{Context, Poll},
};

use bytes::Bytes;
use futures_util::Stream;
use http::{HeaderValue, header};
use http_body::Frame;
use prost::Message;
use strew_service::unpack::Coding;
use tonic::Status;

use super::{compression, status};
use crate::body::{Body, BoxError, Response};

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

/// A frame whose message is compressed.
fn packed(coding: Coding, frame: &[u8]) -> Result<Bytes, Status> {
    let message = frame.get(PREFIX..).unwrap_or_default();
    let packed = compression::pack(coding, vec![0; PREFIX], message);
    let failed = |error| Status::internal(format!("Error compressing: {error}"));
    let mut frame = packed.map_err(failed)?;
    let length = frame.len() - PREFIX;
    frame[..PREFIX].copy_from_slice(&prefix(length));
    frame[0] = 1;
    Ok(frame.into())
}

/// Messages with their prefixes, one by one.
pub(super) type FrameStream = Pin<Box<dyn Stream<Item = Result<Bytes, Status>> + Send>>;

/// The messages of an answer, with their prefixes.
pub(super) enum Frames {
    /// One message; empty once it is taken.
    One(Bytes),
    Many(FrameStream),
}

impl Frames {
    /// One message.
    pub(super) fn one(message: &impl Message) -> Self {
        Self::One(framed(message))
    }

    /// The answer of these messages, compressed if there is a coding.
    pub(super) fn response(self, coding: Option<Coding>) -> Response {
        let mut response = Response::new(Body::new(Framed {
            frames: Some(self),
            coding,
        }));
        let headers = response.headers_mut();
        let content_type = HeaderValue::from_static("application/grpc");
        headers.insert(header::CONTENT_TYPE, content_type);
        if let Some(coding) = coding {
            let name = HeaderValue::from_static(compression::name(coding));
            headers.insert(compression::SENT, name);
        }
        response
    }

    fn poll_next(&mut self, cx: &mut Context<'_>) -> Poll<Option<Result<Bytes, Status>>> {
        match self {
            Self::One(frame) if frame.is_empty() => Poll::Ready(None),
            Self::One(frame) => Poll::Ready(Some(Ok(take(frame)))),
            Self::Many(frames) => frames.as_mut().poll_next(cx),
        }
    }
}

/// Frames, then the status.
struct Framed {
    /// The frames; none after the status.
    frames: Option<Frames>,
    coding: Option<Coding>,
}

impl http_body::Body for Framed {
    type Data = Bytes;
    type Error = BoxError;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, BoxError>>> {
        let Some(frames) = &mut self.frames else {
            return Poll::Ready(None);
        };
        let next = match frames.poll_next(cx) {
            Poll::Pending => return Poll::Pending,
            Poll::Ready(next) => next.transpose(),
        };
        let next = next.and_then(|frame| match (frame, self.coding) {
            (Some(frame), Some(coding)) => packed(coding, &frame).map(Some),
            (frame, _) => Ok(frame),
        });
        let trailers = match next {
            Ok(Some(frame)) => return Poll::Ready(Some(Ok(Frame::data(frame)))),
            Ok(None) => Some(status::fine()),
            Err(status) => status::trailers(&status),
        };
        self.frames = None;
        Poll::Ready(trailers.map(|trailers| Ok(Frame::trailers(trailers))))
    }

    fn is_end_stream(&self) -> bool {
        self.frames.is_none()
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use super::*;

    #[test]
    fn a_packed_frame_holds_the_message() {
        let message = b"points ".repeat(1000);
        let frame = [&prefix(message.len())[..], &message].concat();
        for coding in [Coding::Gzip, Coding::Zstd] {
            let packed = packed(coding, &frame).expect("packed");
            let (prefix, bytes) = packed.split_at(PREFIX);
            let length = u32::try_from(bytes.len()).expect("short").to_be_bytes();
            assert_eq!(prefix, [&[1][..], &length].concat());
            let mut reader: Box<dyn std::io::Read> = match coding {
                Coding::Gzip => Box::new(flate2::read::GzDecoder::new(bytes)),
                Coding::Zstd => Box::new(zstd::stream::read::Decoder::new(bytes).expect("one")),
            };
            let mut unpacked = vec![];
            let read = reader.read_to_end(&mut unpacked);
            assert_eq!(read.ok(), Some(message.len()));
            assert_eq!(unpacked, message, "{coding:?}");
        }
    }
}
