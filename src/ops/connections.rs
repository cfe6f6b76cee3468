//! Connections: accepted up to a limit, with TLS or without, timed out when idle, and closed
//! gracefully.
//!
//! Each connection is a task that runs the HTTP library over a guarded socket. Beyond the limit a
//! client is refused. A connection frees its place when the client leaves, is idle, or takes nothing.

use std::{convert::Infallible, io, net::SocketAddr, sync::Arc, time::Duration};

use http::Request;
use hyper::{body::Incoming, service::service_fn};
use hyper_util::{
    rt::{TokioExecutor, TokioIo, TokioTimer},
    server::conn::auto::Builder,
};
use prometheus::IntCounter;
use strew_config::{Server, seconds};
use strew_error::Error;
use strew_service::access::{Gate, InUse, OneOf, Quota};
use tokio::{
    io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _},
    net::{TcpListener, TcpStream},
    sync::Semaphore,
};
use tokio_util::{sync::CancellationToken, task::TaskTracker};

use super::{
    app::Steps,
    exchange::{Exchanges, Fate},
    guarded::Guarded,
    step::Next as _,
    telemetry::LogThrottle,
    tls::Tls,
};
use crate::{body::Body, rest};

/// Takes connections and serves them.
pub(super) struct Connections {
    http: Builder<TokioExecutor>,
    tls: Option<Tls>,
    /// The times for the first bytes of a client, without a request, and for taking something.
    opening: Duration,
    idle: Duration,
    stalled: Duration,
    places: Arc<Quota>,
    /// Places for refusals in progress.
    telling: Arc<Semaphore>,
    /// The limits of addresses; nothing on the address of administrators.
    gate: Option<Arc<Gate>>,
    refused: LogThrottle,
    failed: LogThrottle,
    unshaken: LogThrottle,
    handshakes: IntCounter,
    running: TaskTracker,
    /// No more connections are taken, and those that are open end when they are idle.
    closing: CancellationToken,
    /// Connections end.
    ended: CancellationToken,
}

/// The most connections beyond the limit that are answered 503 at once; others are just closed.
const REFUSALS_AT_ONCE: usize = 64;
const REFUSAL_TIME: Duration = Duration::from_secs(1);
/// The wait after the system refused a connection.
const OUT_OF_FILES: Duration = Duration::from_millis(50);
/// The most bytes that the system buffers for a reader beyond those being sent. Bounds its memory, and
/// shows soon that a slow reader has taken something.
#[cfg(any(target_os = "android", target_os = "linux"))]
const UNSENT: u32 = 512 << 10;

impl Connections {
    pub(super) fn new(
        settings: &Server,
        tls: Option<Tls>,
        gate: Option<Arc<Gate>>,
        handshakes: IntCounter,
    ) -> Self {
        Self {
            http: http(settings),
            tls,
            opening: seconds(settings.header_read_timeout_seconds),
            idle: seconds(settings.idle_connection_seconds),
            stalled: seconds(settings.stalled_reader_seconds),
            places: Arc::new(Quota::new(settings.max_connections)),
            telling: Arc::new(Semaphore::new(REFUSALS_AT_ONCE)),
            gate,
            refused: LogThrottle::default(),
            failed: LogThrottle::default(),
            unshaken: LogThrottle::default(),
            handshakes,
            running: TaskTracker::new(),
            closing: CancellationToken::new(),
            ended: CancellationToken::new(),
        }
    }

    pub(super) async fn take(self: Arc<Self>, listener: TcpListener, front: Arc<Front>) {
        loop {
            let taken = tokio::select! {
                biased;
                () = self.closing.cancelled() => return,
                taken = listener.accept() => taken,
            };
            match taken {
                Ok((stream, peer)) => self.place(stream, peer, &front),
                Err(error) if is_of_the_client(&error) => {}
                Err(error) => {
                    if let Some(times) = self.failed.record() {
                        tracing::error!(%error, times, "no connection can be taken");
                    }
                    tokio::time::sleep(OUT_OF_FILES).await;
                }
            }
        }
    }

    fn place(self: &Arc<Self>, stream: TcpStream, peer: SocketAddr, front: &Arc<Front>) {
        match self.places_of(peer) {
            Ok(places) => {
                let (this, front) = (self.clone(), front.clone());
                self.running.spawn(async move {
                    this.serve(stream, peer, front).await;
                    drop(places);
                });
            }
            Err(error) => {
                if let Some(times) = self.refused.record() {
                    tracing::warn!(%peer, %error, times, "connections are refused");
                }
                // Before a handshake nothing can be said in TLS.
                let telling = self.telling.clone().try_acquire_owned();
                if let (None, Ok(telling)) = (&self.tls, telling) {
                    self.running.spawn(async move {
                        let _ = tokio::time::timeout(REFUSAL_TIME, refuse(stream, error)).await;
                        drop(telling);
                    });
                }
            }
        }
    }

    /// Takes no more connections; those that are open end with their last answer.
    pub(super) fn close(&self) {
        self.closing.cancel();
        self.running.close();
    }

    pub(super) async fn closed(&self) {
        self.running.wait().await;
    }

    pub(super) fn end(&self) {
        self.ended.cancel();
    }

    /// A place among all connections, and one among those of the address.
    fn places_of(&self, peer: SocketAddr) -> Result<(OneOf, Option<InUse>), Error> {
        let usage = self.gate.as_ref().map(|gate| gate.usage(peer.ip()));
        let of_address = usage.map(|usage| usage.connection(&self.places));
        let limit = self.places.limit();
        let place = self.places.clone().one();
        let place = place.ok_or(Error::TooManyConnections { limit })?;
        Ok((place, of_address.transpose()?))
    }

    async fn serve(&self, stream: TcpStream, peer: SocketAddr, front: Arc<Front>) {
        let _ = stream.set_nodelay(true);
        #[cfg(any(target_os = "android", target_os = "linux"))]
        let _ = socket2::SockRef::from(&stream).set_tcp_notsent_lowat(UNSENT);
        let stream = Guarded::new(stream).taking_within(self.stalled);
        match &self.tls {
            None => self.converse(stream, peer, front).await,
            Some(tls) => {
                let handshake = tls.acceptor().accept(stream);
                let handshake = tokio::time::timeout(self.opening, handshake);
                let shaken = tokio::select! {
                    shaken = handshake => shaken,
                    () = self.closing.cancelled() => return,
                };
                match shaken {
                    Ok(Ok(stream)) => self.converse(Guarded::new(stream), peer, front).await,
                    Ok(Err(error)) => self.no_handshake(peer, &error.to_string()),
                    Err(_) => self.no_handshake(peer, "it took too long"),
                }
            }
        }
    }

    /// Logs a failed handshake: one in a while at a level that is seen, since anyone can cause them.
    fn no_handshake(&self, peer: SocketAddr, error: &str) {
        self.handshakes.inc();
        match self.unshaken.record() {
            Some(times) => tracing::warn!(%peer, error, times, "a TLS handshake failed"),
            None => tracing::debug!(%peer, error, "a TLS handshake failed"),
        }
    }

    async fn converse<S>(&self, stream: Guarded<S>, peer: SocketAddr, front: Arc<Front>)
    where
        S: AsyncRead + AsyncWrite + Unpin + Send + 'static,
    {
        let from = front.exchanges.from(peer);
        let open = from.open.clone();
        let service = service_fn(move |request: Request<Incoming>| {
            let (front, from) = (front.clone(), from.clone());
            let inbound = front.exchanges.inbound(from, request.map(Body::new));
            Box::pin(async move { Ok::<_, Infallible>(front.steps.answer(inbound).await) })
        });
        let stream = TokioIo::new(stream.opening_within(self.opening));
        let connection = self.http.serve_connection(stream, service);
        tokio::pin!(connection);
        let mut is_closing = false;
        loop {
            // A connection that is to end is not idle, whatever it waits for.
            let idle = if is_closing { Duration::MAX } else { self.idle };
            tokio::select! {
                ended = connection.as_mut() => {
                    if let Err(error) = ended {
                        tracing::debug!(%peer, %error, "a connection broke");
                    }
                    return;
                }
                () = self.ended.cancelled() => return,
                () = self.closing.cancelled(), if !is_closing => {}
                fate = open.decided(idle, self.stalled, is_closing) => if fate == Fate::Close {
                    // A goodbye would wait for the answers that the client leaves untouched.
                    tracing::debug!(%peer, "the client takes none of its answers");
                    return;
                },
            }
            if !is_closing {
                is_closing = true;
                connection.as_mut().graceful_shutdown();
            }
        }
    }
}

/// The settings of HTTP: the bounds on one connection. (The bound on heads also bounds what
/// HTTP/1.1 gathers before it writes; blocks are larger than that and go out as they are.)
fn http(settings: &Server) -> Builder<TokioExecutor> {
    /// The bytes that an HTTP/2 client may send before they are read, by request and by connection: queries are
    /// short, and thousands of connections may fill their windows at once.
    const REQUEST_WINDOW: u32 = 64 << 10;
    const CONNECTION_WINDOW: u32 = 256 << 10;
    let keepalive = seconds(settings.http2_keepalive_seconds);
    // A head that is only a little too long is refused in words, by `rest::Finish`.
    let most = settings.max_header_bytes.saturating_mul(2);
    let mut builder = Builder::new(TokioExecutor::new());
    builder
        .http1()
        .timer(TokioTimer::new())
        .header_read_timeout(seconds(settings.header_read_timeout_seconds))
        .max_buf_size(usize::try_from(most).unwrap_or(usize::MAX));
    builder
        .http2()
        .timer(TokioTimer::new())
        .max_header_list_size(most)
        .initial_stream_window_size(REQUEST_WINDOW)
        .initial_connection_window_size(CONNECTION_WINDOW)
        .max_concurrent_streams(settings.max_requests_per_connection)
        .keep_alive_interval(keepalive)
        .keep_alive_timeout(keepalive);
    builder
}

pub(super) struct Front {
    pub(super) exchanges: Exchanges,
    pub(super) steps: Steps,
}

/// Errors of a client that left before it was let in.
fn is_of_the_client(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionAborted, ConnectionRefused, ConnectionReset};
    matches!(
        error.kind(),
        ConnectionAborted | ConnectionRefused | ConnectionReset
    )
}

/// Tells a client that there is no place, and hears it out: a socket that is closed with words
/// unread takes back what was said.
async fn refuse(mut stream: TcpStream, error: Error) -> io::Result<()> {
    const HEARD: u64 = 1 << 16;
    stream.write_all(&rest::last_words(&error)).await?;
    stream.shutdown().await?;
    tokio::io::copy(&mut stream.take(HEARD), &mut tokio::io::sink()).await?;
    Ok(())
}
