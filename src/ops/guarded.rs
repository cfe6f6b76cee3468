//! Sockets that do not wait forever: for a client's first words, and for a reader that takes nothing.
//!
//! The HTTP library bounds the head of an HTTP/1.1 request and asks quiet HTTP/2 clients for a sign of
//! life. What it leaves open is closed here: a connection that never says which HTTP it speaks, and
//! one whose receiver has stopped receiving. Reads are short, so that buffers stay small.

use std::{
    io,
    pin::Pin,
    task::{Context, Poll},
    time::Duration,
};

use bytes::BufMut as _;
use tokio::{
    io::{AsyncRead, AsyncWrite, ReadBuf},
    time::{Instant, Sleep, sleep},
};
use tokio_util::io::poll_read_buf;

/// The bytes that are read at once. The HTTP library reads into a buffer of 8 KiB, which it doubles each time it
/// is filled: a connection would then hold 256 KiB until it is closed.
const AT_ONCE: usize = (8 << 10) - 1;
/// The length of the preface of HTTP/2. After that the timeouts of the HTTP library apply.
const OPENING: usize = 24;

fn too_late(what: &'static str) -> io::Error {
    io::Error::new(io::ErrorKind::TimedOut, what)
}

/// A socket that is read in small parts, and whose client may be bound: to send its first bytes soon, and to take
/// something now and then, while there is something to take.
pub(super) struct Guarded<S> {
    stream: S,
    read: usize,
    /// Set until the client has sent enough, or has been answered.
    opening: Option<Pin<Box<Sleep>>>,
    /// The time for which the receiver may take nothing.
    patience: Option<Duration>,
    /// Made when the socket is full for the first time.
    full: Option<Pin<Box<Sleep>>>,
    is_full: bool,
}

impl<S> Guarded<S> {
    pub(super) fn new(stream: S) -> Self {
        Self {
            stream,
            read: 0,
            opening: None,
            patience: None,
            full: None,
            is_full: false,
        }
    }

    /// With this time for the first bytes of the client.
    pub(super) fn opening_within(mut self, time: Duration) -> Self {
        self.opening = Some(Box::pin(sleep(time)));
        self
    }

    /// With this time for which the receiver may take nothing.
    pub(super) fn taking_within(mut self, time: Duration) -> Self {
        self.patience = Some(time);
        self
    }

    /// The result of a write, unless the socket has been full for too long.
    fn moved<T>(
        &mut self,
        cx: &mut Context<'_>,
        polled: Poll<io::Result<T>>,
    ) -> Poll<io::Result<T>> {
        let (Some(patience), Poll::Pending) = (self.patience, &polled) else {
            self.is_full = false;
            return polled;
        };
        let full = self.full.get_or_insert_with(|| Box::pin(sleep(patience)));
        if !self.is_full {
            full.as_mut().reset(Instant::now() + patience);
            self.is_full = true;
        }
        match full.as_mut().poll(cx) {
            Poll::Ready(()) => Poll::Ready(Err(too_late("the receiver takes nothing"))),
            Poll::Pending => Poll::Pending,
        }
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Guarded<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let before = buffer.filled().len();
        let mut room = buffer.limit(AT_ONCE);
        let polled = poll_read_buf(Pin::new(&mut self.stream), cx, &mut room);
        let read = buffer.filled().len() - before;
        if let Some(opening) = &mut self.opening {
            if polled.is_ready() {
                self.read += read;
                if self.read >= OPENING {
                    self.opening = None;
                }
            } else if opening.as_mut().poll(cx).is_ready() {
                return Poll::Ready(Err(too_late("the client says nothing")));
            }
        }
        polled.map_ok(|_| ())
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Guarded<S> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        self.opening = None;
        let polled = Pin::new(&mut self.stream).poll_write(cx, bytes);
        self.moved(cx, polled)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        self.opening = None;
        let polled = Pin::new(&mut self.stream).poll_write_vectored(cx, slices);
        self.moved(cx, polled)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        let polled = Pin::new(&mut self.stream).poll_flush(cx);
        self.moved(cx, polled)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        let polled = Pin::new(&mut self.stream).poll_shutdown(cx);
        self.moved(cx, polled)
    }
}
