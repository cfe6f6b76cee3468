//! Connections: taken up to a limit, watched for silence, spoken to in TLS or plainly, and ended in
//! good order.
//!
//! Each connection is a task that runs the HTTP library over a guarded socket. Beyond the limit a
//! client is told so and goes; who holds a place gives it back by going, by being silent, or by
//! taking nothing.

use std::{io, net::SocketAddr, sync::Arc, time::Duration};

use axum::{Router, body::Body};
use http::{Request, Response};
use hyper::{body::Incoming, service::Service as HyperService};
use hyper_util::{
    rt::{TokioExecutor, TokioIo, TokioTimer},
    server::conn::auto::Builder,
    service::TowerToHyperService,
};
use tokio::{
    io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _},
    net::{TcpListener, TcpStream},
    sync::{OwnedSemaphorePermit, Semaphore},
};
use tokio_util::{sync::CancellationToken, task::TaskTracker};

use super::{
    activity::{Activity, Answering, Still},
    guarded::{Moving, Opening},
    often::Often,
    tls::Tls,
};
use crate::{
    config::{Server, seconds},
    rest,
};

/// Who asks: every request carries it among its extensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Peer(pub SocketAddr);

/// Takes connections and serves them. Cheap to clone.
#[derive(Clone)]
pub(super) struct Connections {
    shared: Arc<Shared>,
}

struct Shared {
    http: Builder<TokioExecutor>,
    tls: Option<Tls>,
    patience: Patience,
    limit: usize,
    places: Arc<Semaphore>,
    /// Those that are being told that there is no place.
    told: Arc<Semaphore>,
    refused: Often,
    failed: Often,
    running: TaskTracker,
    /// No more connections are taken, and those that are open end when they are idle.
    closing: CancellationToken,
    /// Connections end.
    ended: CancellationToken,
}

/// How long is waited for what.
#[derive(Clone, Copy, Debug)]
struct Patience {
    opening: Duration,
    idle: Duration,
    stalled: Duration,
}

/// So many refused clients are told why at once; others find the connection closed.
const TOLD_AT_ONCE: usize = 64;
/// How long telling may take.
const TELLING: Duration = Duration::from_secs(1);
/// How long to wait when the system gives no more connections.
const OUT_OF_FILES: Duration = Duration::from_millis(50);
/// The system keeps at most so many bytes for a reader beyond what is on its way. That bounds its
/// memory, and lets us notice soon that a slow reader has taken something.
#[cfg(any(target_os = "android", target_os = "linux"))]
const UNSENT: u32 = 512 << 10;

impl Connections {
    pub(super) fn new(settings: &Server, tls: Option<Tls>) -> Self {
        let limit = settings.max_connections;
        let shared = Shared {
            http: http(settings),
            tls,
            patience: Patience {
                opening: seconds(settings.header_read_timeout_seconds),
                idle: seconds(settings.idle_connection_seconds),
                stalled: seconds(settings.stalled_reader_seconds),
            },
            limit,
            places: Arc::new(Semaphore::new(limit)),
            told: Arc::new(Semaphore::new(TOLD_AT_ONCE)),
            refused: Often::default(),
            failed: Often::default(),
            running: TaskTracker::new(),
            closing: CancellationToken::new(),
            ended: CancellationToken::new(),
        };
        Self {
            shared: Arc::new(shared),
        }
    }

    /// Takes connections until [`close`](Self::close).
    pub(super) async fn take(&self, listener: TcpListener, router: Router) {
        let shared = &self.shared;
        loop {
            let taken = tokio::select! {
                biased;
                () = shared.closing.cancelled() => return,
                taken = listener.accept() => taken,
            };
            match taken {
                Ok((stream, peer)) => self.place(stream, peer, &router),
                Err(error) if is_of_the_client(&error) => {}
                Err(error) => {
                    if let Some(times) = shared.failed.once_more() {
                        tracing::error!(%error, times, "no connection can be taken");
                    }
                    tokio::time::sleep(OUT_OF_FILES).await;
                }
            }
        }
    }

    /// Gives a connection a place, or tells it that there is none.
    fn place(&self, stream: TcpStream, peer: SocketAddr, router: &Router) {
        let shared = self.shared.clone();
        if let Ok(place) = shared.places.clone().try_acquire_owned() {
            let router = router.clone();
            let running = shared.running.clone();
            running.spawn(async move { shared.serve(stream, peer, router, place).await });
            return;
        }
        let limit = shared.limit;
        if let Some(times) = shared.refused.once_more() {
            tracing::warn!(
                limit,
                times,
                "connections are refused: server.max_connections are open"
            );
        }
        // Before a handshake nothing can be said in TLS.
        let told = shared.told.clone().try_acquire_owned();
        if let (None, Ok(told)) = (&shared.tls, told) {
            shared.running.spawn(async move {
                let _ = tokio::time::timeout(TELLING, tell(stream, limit)).await;
                drop(told);
            });
        }
    }

    /// Takes no more connections; those that are open end with their last answer.
    pub(super) fn close(&self) {
        self.shared.closing.cancel();
        self.shared.running.close();
    }

    /// Waits until the last connection has ended.
    pub(super) async fn closed(&self) {
        self.shared.running.wait().await;
    }

    /// Ends every connection now.
    pub(super) fn end(&self) {
        self.shared.ended.cancel();
    }
}

impl Shared {
    async fn serve(
        &self,
        stream: TcpStream,
        peer: SocketAddr,
        router: Router,
        place: OwnedSemaphorePermit,
    ) {
        let _ = stream.set_nodelay(true);
        #[cfg(any(target_os = "android", target_os = "linux"))]
        let _ = socket2::SockRef::from(&stream).set_tcp_notsent_lowat(UNSENT);
        let stream = Moving::new(stream, self.patience.stalled);
        match &self.tls {
            None => self.converse(stream, peer, router).await,
            Some(tls) => {
                let handshake = tls.acceptor().accept(stream);
                let handshake = tokio::time::timeout(self.patience.opening, handshake);
                let shaken = tokio::select! {
                    shaken = handshake => shaken,
                    () = self.closing.cancelled() => return,
                };
                match shaken {
                    Ok(Ok(stream)) => self.converse(stream, peer, router).await,
                    Ok(Err(error)) => tracing::debug!(%peer, %error, "no TLS handshake"),
                    Err(_) => tracing::debug!(%peer, "the TLS handshake took too long"),
                }
            }
        }
        drop(place);
    }

    async fn converse<S>(&self, stream: S, peer: SocketAddr, router: Router)
    where
        S: AsyncRead + AsyncWrite + Unpin + Send + 'static,
    {
        let activity = Arc::new(Activity::default());
        let service = Answers {
            router: TowerToHyperService::new(router),
            peer: Peer(peer),
            activity: activity.clone(),
        };
        let stream = TokioIo::new(Opening::new(stream, self.patience.opening));
        let connection = self.http.serve_connection(stream, service);
        let still = activity.still(self.patience.idle, self.patience.stalled);
        tokio::pin!(connection, still);
        let mut is_closing = false;
        loop {
            tokio::select! {
                ended = connection.as_mut() => {
                    if let Err(error) = ended {
                        tracing::debug!(%peer, %error, "a connection broke");
                    }
                    return;
                }
                () = self.ended.cancelled() => return,
                () = self.closing.cancelled(), if !is_closing => {}
                still = &mut still, if !is_closing => if still == Still::Stalled {
                    // A goodbye would wait for the answers that nobody takes.
                    tracing::debug!(%peer, "nothing is taken of any answer");
                    return;
                },
            }
            is_closing = true;
            connection.as_mut().graceful_shutdown();
        }
    }
}

/// How HTTP is spoken: what one connection may ask of us. (The bound on heads also bounds what
/// HTTP/1.1 gathers before it writes; blocks are larger than that and go out as they are.)
fn http(settings: &Server) -> Builder<TokioExecutor> {
    /// What an HTTP/2 client may send before it is read, by request and by connection: queries are
    /// short, and thousands of connections may fill their windows at once.
    const REQUEST_WINDOW: u32 = 64 << 10;
    const CONNECTION_WINDOW: u32 = 256 << 10;
    let keepalive = seconds(settings.http2_keepalive_seconds);
    // A head that is only a little too long is refused in words, by `rest::finished`.
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

/// Answers the requests of one connection.
struct Answers {
    router: TowerToHyperService<Router>,
    peer: Peer,
    activity: Arc<Activity>,
}

impl HyperService<Request<Incoming>> for Answers {
    type Response = Response<Answering<Body>>;
    type Error = std::convert::Infallible;
    type Future = futures_util::future::BoxFuture<'static, Result<Self::Response, Self::Error>>;

    fn call(&self, mut request: Request<Incoming>) -> Self::Future {
        request.extensions_mut().insert(self.peer);
        let under_way = self.activity.begin();
        let answer = self.router.call(request);
        Box::pin(async move {
            let answer = answer.await?;
            Ok(answer.map(|body| Answering::new(body, under_way)))
        })
    }
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
async fn tell(mut stream: TcpStream, limit: usize) -> io::Result<()> {
    /// No more is heard.
    const HEARD: u64 = 1 << 16;
    stream.write_all(&rest::no_place(limit)).await?;
    stream.shutdown().await?;
    tokio::io::copy(&mut stream.take(HEARD), &mut tokio::io::sink()).await?;
    Ok(())
}
