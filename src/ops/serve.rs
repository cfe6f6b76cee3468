//! Serving: both protocols on one port, until the daemon is stopped, and then not much longer.

use std::{io, net::TcpListener, sync::Arc, time::Duration};

use anyhow::Context as _;
use strew_catalog::{Catalog, except::Lists, field::Fields};
use strew_config as config;
use strew_config::Config;
use strew_query::{Assets, Worlds};
use strew_service::access::Gate;
use strew_service::{Service, Workers};
use tokio_util::task::AbortOnDropHandle;

use super::{
    app,
    connections::{Connections, Front},
    exchange::{self, Exchanges, Intake},
    health::{self, Readiness},
    metrics::{self, Metrics},
    reload::{self, Reloader, Watched},
    shutdown::Hangups,
    spans::{Collector, Spans},
    tls::Tls,
    trim,
};
use crate::{
    grpc,
    rest::{self, Routes, api::Endpoint},
};

/// The time that streams have at a stop to send their last message to their readers.
const GRACE: Duration = Duration::from_secs(1);

pub struct App {
    config: Config,
    service: Arc<Service>,
    gate: Arc<Gate>,
    reloader: Arc<Reloader>,
    /// The socket of administrators.
    pub admin: Option<TcpListener>,
    /// Tables are read again whenever these come.
    pub hangups: Option<Hangups>,
    tls: Option<Tls>,
    metrics: Metrics,
    collector: Option<Collector>,
    spans: Option<Spans>,
    pub pages: rest::Pages,
    /// Further paths on the same port, which are not described.
    pub more: Vec<Endpoint>,
}

impl App {
    /// Reads the certificates and keys, loads the tables and starts the workers.
    pub fn new(config: Config) -> anyhow::Result<Self> {
        let watched = Watched::of(&config);
        // Before anything is read: what changes from here on is noticed.
        let first = watched.look();
        let tls = Tls::new(&config.tls)?;
        let collector = Collector::new(&config.telemetry)?;
        let (tables, folder) = (&config.tables, config.tables.folder());
        let fields = Fields::load(&config.fields)?;
        let catalog = Catalog::preloading(tables.preload_bytes, tables.embedded, folder)?;
        let catalog = catalog.with_fields(fields);
        let catalog = catalog.with_room(config.fields.max_sent_bytes);
        let workers = Workers::new(config.workers.threads);
        // For what work does side by side. There may be such threads already, where this is part of a program.
        let side_by_side = rayon::ThreadPoolBuilder::new().num_threads(config.workers.threads);
        let _ = side_by_side.build_global();
        let metrics = Metrics::default();
        let lists = Lists::load(&config.except)?;
        let catalog = catalog.with_except(lists);
        let worlds = Worlds::load(&config.worlds, &catalog, config.limits.max_vertices)?;
        let assets = Assets::from(catalog).with_worlds(worlds);
        let service = Service::new(assets, config.limits.clone(), workers);
        let mixes = folder.map(|folder| folder.join("mixes"));
        let service = Arc::new(service.with_mixes(mixes));
        let gate = Arc::new(Gate::new(
            config.access.clone(),
            &config.rate,
            config.per_address.clone(),
        )?);
        let reloader = Reloader::new(
            service.clone(),
            gate.clone(),
            tls.clone(),
            (watched, first),
            metrics.clone(),
        );
        Ok(Self {
            gate,
            reloader: Arc::new(reloader),
            admin: None,
            hangups: None,
            config,
            service,
            tls,
            metrics,
            collector,
            spans: None,
            pages: rest::Pages::default(),
            more: vec![],
        })
    }

    pub fn admin_address(&self) -> Option<std::net::SocketAddr> {
        self.admin.as_ref()?.local_addr().ok()
    }

    pub const fn service(&self) -> &Arc<Service> {
        &self.service
    }

    /// Serves until `shutdown` is over, then drains for as long as the settings allow. Returns
    /// the number of streams that had to be broken off.
    pub async fn run(
        mut self,
        listener: TcpListener,
        shutdown: impl Future<Output = ()>,
    ) -> anyhow::Result<usize> {
        let Some(collector) = self.collector.take() else {
            return self.serve(listener, shutdown).await;
        };
        let (spans, sending) = collector.start(&self.metrics)?;
        self.spans = Some(spans);
        let served = self.serve(listener, shutdown).await;
        sending.finish().await;
        served
    }

    async fn serve(
        mut self,
        listener: TcpListener,
        shutdown: impl Future<Output = ()>,
    ) -> anyhow::Result<usize> {
        let _watch = self.watch();
        let readiness = Readiness::within(config::seconds(self.config.server.ready_within_seconds));
        let (calls, grpc_health) = grpc::calls(self.service.clone())
            .await
            .context("cannot serve gRPC")?;
        let front = self.front(readiness.clone(), &listener, Some(calls));
        let watch = readiness.clone();
        let watch = watch.watch(self.service.workers().clone(), grpc_health.clone());
        let _pulse = AbortOnDropHandle::new(tokio::spawn(watch));
        let trimming = trim::watch(self.service.budget().clone());
        let _trimming = AbortOnDropHandle::new(tokio::spawn(trimming));
        let listener = asynchronous(listener).context("cannot serve")?;
        let handshakes = &self.metrics.failed_handshakes;
        let server = &self.config.server;
        let admins = Connections::new(server, self.tls.clone(), None, handshakes.clone());
        let admins = Arc::new(admins);
        if let Some(listener) = self.admin.take() {
            let front = self.front(readiness.clone(), &listener, None);
            let listener = asynchronous(listener).context("cannot serve")?;
            tokio::spawn(admins.clone().take(listener, Arc::new(front)));
        }
        let _admins = EndOnDrop(admins);
        let gate = Some(self.gate.clone());
        let connections = Connections::new(server, self.tls.clone(), gate, handshakes.clone());
        let connections = Arc::new(connections);
        let taking = tokio::spawn(connections.clone().take(listener, Arc::new(front)));
        shutdown.await;
        readiness.close();
        grpc_health.set(false).await;
        tokio::time::sleep(config::seconds(self.config.shutdown.notice_seconds)).await;
        connections.close();
        // From here on the port is free for another.
        let _ = taking.await;

        // The last connection ends it; if that takes too long, streams are broken off so that
        // readers see it, and then so are connections.
        let drain = config::seconds(self.config.shutdown.drain_seconds);
        let closed = tokio::time::timeout(drain, connections.closed());
        if closed.await.is_ok() {
            return Ok(0);
        }
        let broken = self.service.streams().open();
        self.metrics.ends.cancel();
        self.service.streams().stop();
        let closed = tokio::time::timeout(GRACE, connections.closed());
        if closed.await.is_err() {
            connections.end();
            connections.closed().await;
        }
        Ok(broken)
    }

    /// Watches files while the handle is held.
    fn watch(&mut self) -> AbortOnDropHandle<()> {
        let seconds = self.config.reload.watch_seconds;
        let is_looked_for = seconds > 0.0 && self.reloader.has_files();
        let every = is_looked_for.then(|| config::seconds(seconds));
        let hangups = self.hangups.take();
        let reloader = self.reloader.clone();
        AbortOnDropHandle::new(tokio::spawn(async move {
            reloader.watch(hangups, every).await;
        }))
    }

    /// The steps for a socket: calls and all of REST, or without calls the paths of administrators.
    fn front(
        &self,
        readiness: Readiness,
        listener: &TcpListener,
        calls: Option<grpc::Calls>,
    ) -> Front {
        let is_for_all = calls.is_some();
        let mut endpoints = match is_for_all {
            true => rest::endpoints(&self.service),
            false => vec![],
        };
        endpoints.extend(health::endpoints(readiness, self.service.clone()));
        endpoints.push(reload::endpoint(self.reloader.clone()));
        if self.config.metrics.enabled {
            let (metrics, service) = (self.metrics.clone(), self.service.clone());
            endpoints.push(metrics::endpoint(metrics, service));
        }
        let more = if is_for_all { &self.more[..] } else { &[] };
        let finish = rest::Finish::new(
            &self.config,
            self.gate.settings().needs_key(),
            is_on_loopback(listener),
            self.service.clone(),
        );
        let exchanges = Exchanges {
            metrics: Arc::new(self.metrics.clone()),
            spans: self.spans.clone(),
            gate: self.gate.clone(),
            budget: self.service.budget().clone(),
            terms: exchange::terms(&self.config.server),
        };
        let intake = || Intake::new(&self.config, self.service.budget().clone());
        let gate = is_for_all.then(|| self.gate.clone());
        let bounds = (is_for_all.then(intake), gate);
        let routes = Routes::new(endpoints, more, &self.pages, &self.config.http.public_url);
        Front {
            steps: app::steps(exchanges.clone(), finish, routes, calls, bounds),
            exchanges,
        }
    }
}

/// Connections that end with the daemon.
struct EndOnDrop(Arc<Connections>);

impl Drop for EndOnDrop {
    fn drop(&mut self) {
        self.0.close();
        self.0.end();
    }
}

/// Whether only programs of this machine reach a socket.
fn is_on_loopback(listener: &TcpListener) -> bool {
    let address = listener.local_addr();
    address.is_ok_and(|address| address.ip().to_canonical().is_loopback())
}

fn asynchronous(listener: TcpListener) -> io::Result<tokio::net::TcpListener> {
    listener.set_nonblocking(true)?;
    tokio::net::TcpListener::from_std(listener)
}
