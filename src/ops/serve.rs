//! Serving: both doors on one port, until asked to stop, and then not much longer.

use std::{
    io,
    net::{SocketAddr, TcpListener},
    sync::Arc,
    time::Duration,
};

use axum::{Router, body::Body, extract::Request, response::Response};
use axum_server::Handle;
use hyper_util::rt::TokioTimer;

use super::{
    calls,
    health::{self, Readiness},
    metrics::{self, Metrics},
    observe,
};
use crate::{
    config::{self, Config},
    grpc, rest,
    service::{Catalog, Service, Workers, catalog::CatalogError},
};

/// Why the daemon cannot start or go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServeError {
    /// The tables cannot be loaded.
    #[error(transparent)]
    Catalog(#[from] CatalogError),
    /// No threads to work with.
    #[error("cannot start the workers: {0}")]
    Workers(#[from] rayon::ThreadPoolBuildError),
    /// The program was built wrongly.
    #[error("cannot open the gRPC door: {0}")]
    Grpc(#[from] grpc::BuildError),
    /// The socket does not work.
    #[error("cannot serve: {0}")]
    Socket(#[from] io::Error),
}

/// What is still sent after streams have been told to end: time to tell their readers.
const GRACE: Duration = Duration::from_secs(1);

/// A daemon that is ready to serve.
#[derive(Debug)]
pub struct App {
    config: Config,
    service: Arc<Service>,
    more: Router,
}

impl App {
    /// Loads the tables and starts the workers.
    ///
    /// # Errors
    /// If a table is not valid or the system gives no threads.
    pub fn new(config: Config) -> Result<Self, ServeError> {
        let folder = Some(config.tables.folder.as_path()).filter(|f| !f.as_os_str().is_empty());
        let catalog = Catalog::load(config.tables.embedded, folder)?;
        let workers = Workers::new(config.workers.threads)?;
        let service = Arc::new(Service::new(catalog, config.limits.clone(), workers));
        Ok(Self {
            config,
            service,
            more: Router::new(),
        })
    }

    /// Serves further routes on the same port, behind the same layers.
    #[must_use]
    pub fn with_routes(mut self, routes: Router) -> Self {
        self.more = self.more.merge(routes);
        self
    }

    /// What it serves.
    #[must_use]
    pub const fn service(&self) -> &Arc<Service> {
        &self.service
    }

    /// Serves until `shutdown` is over, then drains for as long as the settings allow and gives
    /// how many streams had to be broken off.
    ///
    /// # Errors
    /// If the socket does not work.
    pub async fn run(
        self,
        listener: TcpListener,
        shutdown: impl Future<Output = ()>,
    ) -> Result<usize, ServeError> {
        let readiness = Readiness::default();
        let (router, grpc_health) = self.router(readiness.clone()).await?;
        listener.set_nonblocking(true)?;
        let handle = Handle::<SocketAddr>::new();
        let mut server = axum_server::from_tcp(listener)?
            .acceptor(axum_server::accept::NoDelayAcceptor::new())
            .handle(handle.clone());
        self.limit_connections(&mut server);
        let served = server.serve(router.into_make_service_with_connect_info::<SocketAddr>());
        tokio::pin!(served);
        tokio::select! {
            () = shutdown => {}
            ended = &mut served => return Ok(ended.map(|()| 0)?),
        }
        readiness.close();
        grpc_health.close().await;
        let notice = config::seconds(self.config.shutdown.notice_seconds);
        tokio::select! {
            () = tokio::time::sleep(notice) => {}
            ended = &mut served => return Ok(ended.map(|()| 0)?),
        }
        let drain = config::seconds(self.config.shutdown.drain_seconds);
        handle.graceful_shutdown(Some(drain.saturating_add(GRACE)));

        // The server ends when the last connection does; if that takes too long, streams are
        // broken off so that readers see it, and then so are connections.
        let mut broken = 0;
        tokio::select! {
            ended = &mut served => ended?,
            () = tokio::time::sleep(drain) => {
                broken = self.service.streams().open();
                self.service.streams().stop();
                served.await?;
            }
        }
        Ok(broken)
    }

    /// Both doors, health, and one fallback for all.
    async fn router(&self, readiness: Readiness) -> Result<(Router, grpc::Health), ServeError> {
        let (grpc, grpc_health) = grpc::routes(self.service.clone()).await?;
        let mut endpoints = rest::endpoints(&self.service);
        endpoints.extend(health::endpoints(readiness, self.service.clone()));
        let metrics = Metrics::default();
        if self.config.metrics.enabled {
            endpoints.push(metrics::endpoint(metrics.clone(), self.service.clone()));
            tokio::spawn(metrics.keep_up());
        }
        let rest::Door { router, paths } = rest::Door::new(endpoints);
        let router = router
            .merge(calls::routes(grpc.into_axum_router().reset_fallback()))
            .merge(self.more.clone())
            .fallback(move |request| nothing_here(request, paths));
        let head_bytes = self.config.server.max_header_bytes;
        let workers = self.service.workers().clone();
        let router = rest::finished(router, &self.config.http, head_bytes, workers);
        Ok((observe::observed(router, metrics), grpc_health))
    }

    /// What one connection may ask of us. (The bound on heads also bounds what HTTP/1.1 gathers
    /// before it writes; blocks are larger than that and go out as they are.)
    fn limit_connections<A>(&self, server: &mut axum_server::Server<SocketAddr, A>) {
        let settings = &self.config.server;
        let keepalive = config::seconds(settings.http2_keepalive_seconds);
        // A head that is only a little too long is refused in words, by `rest::finished`.
        let most = settings.max_header_bytes.saturating_mul(2);
        let builder = server.http_builder();
        builder
            .http1()
            .timer(TokioTimer::new())
            .header_read_timeout(config::seconds(settings.header_read_timeout_seconds))
            .max_buf_size(usize::try_from(most).unwrap_or(usize::MAX));
        builder
            .http2()
            .timer(TokioTimer::new())
            .max_header_list_size(most)
            .max_concurrent_streams(settings.max_requests_per_connection)
            .keep_alive_interval(keepalive)
            .keep_alive_timeout(keepalive);
    }
}

/// Where no door is: each kind of client hears it in its own language.
async fn nothing_here(request: Request, paths: String) -> Response {
    if calls::is_grpc(request.headers()) {
        grpc::unimplemented().map(Body::new)
    } else {
        rest::not_found(&request, &paths)
    }
}
