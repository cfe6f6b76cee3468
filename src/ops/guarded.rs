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

/// A socket whose client must send its first bytes soon, and is read in small parts.
#[derive(Debug)]
pub(super) struct FirstWords<S> {
    stream: S,
    read: usize,
    /// Set until the client has sent enough, or has been answered.
    deadline: Option<Pin<Box<Sleep>>>,
}

impl<S> FirstWords<S> {
    /// A socket whose client has this time for its first bytes.
    pub(super) fn new(stream: S, patience: Duration) -> Self {
        Self {
            stream,
            read: 0,
            deadline: Some(Box::pin(sleep(patience))),
        }
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for FirstWords<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let before = buffer.filled().len();
        let mut room = buffer.limit(AT_ONCE);
        let polled = poll_read_buf(Pin::new(&mut self.stream), cx, &mut room);
        let read = buffer.filled().len() - before;
        if let Some(deadline) = &mut self.deadline {
            match &polled {
                Poll::Pending => {
                    if deadline.as_mut().poll(cx).is_ready() {
                        return Poll::Ready(Err(too_late("the client says nothing")));
                    }
                }
                Poll::Ready(_) => {
                    self.read += read;
                    if self.read >= OPENING {
                        self.deadline = None;
                    }
                }
            }
        }
        polled.map_ok(|_| ())
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for FirstWords<S> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        self.deadline = None;
        Pin::new(&mut self.stream).poll_write(cx, bytes)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        self.deadline = None;
        Pin::new(&mut self.stream).poll_write_vectored(cx, slices)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}

/// A socket whose receiver must take something now and then, while there is something to take.
#[derive(Debug)]
pub(super) struct WriteTimeout<S> {
    stream: S,
    patience: Duration,
    /// Made when the socket is full for the first time.
    deadline: Option<Pin<Box<Sleep>>>,
    is_full: bool,
}

impl<S> WriteTimeout<S> {
    /// A socket whose receiver may take nothing for this time.
    pub(super) fn new(stream: S, patience: Duration) -> Self {
        Self {
            stream,
            patience,
            deadline: None,
            is_full: false,
        }
    }

    /// The result of a write, unless the socket has been full for too long.
    fn moved<T>(
        &mut self,
        cx: &mut Context<'_>,
        polled: Poll<io::Result<T>>,
    ) -> Poll<io::Result<T>> {
        if polled.is_ready() {
            self.is_full = false;
            return polled;
        }
        let patience = self.patience;
        let deadline = self
            .deadline
            .get_or_insert_with(|| Box::pin(sleep(patience)));
        if !self.is_full {
            deadline.as_mut().reset(Instant::now() + patience);
            self.is_full = true;
        }
        match deadline.as_mut().poll(cx) {
            Poll::Ready(()) => Poll::Ready(Err(too_late("the receiver takes nothing"))),
            Poll::Pending => Poll::Pending,
        }
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for WriteTimeout<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(cx, buffer)
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for WriteTimeout<S> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let polled = Pin::new(&mut self.stream).poll_write(cx, bytes);
        self.moved(cx, polled)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
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
