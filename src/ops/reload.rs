//! Reading tables, fields, worlds, keys and certificates again while the daemon serves: on SIGHUP, when files change, on
//! the request of an administrator (`POST /v1/tables:reload`).
//!
//! Files are polled, because notifications of changes do not come through network volumes and the
//! folders that orchestrators mount. They are compared by content, because times of change are too
//! coarse to tell two writes apart.

mod fingerprint;

use std::{
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

use axum::extract::State;
use futures_util::future::OptionFuture;
use http::Method;
use schemars::JsonSchema;
use serde::Serialize;
use strew_catalog::Reload;
use strew_error::{Error, Kind};
use strew_service::Service;
use strew_service::access::Gate;
use tokio::{
    sync::Mutex,
    time::{sleep, timeout},
};

use super::{metrics::Metrics, shutdown::Hangups, tls::Tls};
use crate::{
    body::Response,
    rest::{
        Context, Refused,
        api::{Answer, Endpoint, Operation, Tag},
        json,
    },
};

pub use fingerprint::{Fingerprint, Watched};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    Signal,
    Change,
    Request,
}

impl Cause {
    const fn name(self) -> &'static str {
        match self {
            Self::Signal => "signal",
            Self::Change => "change",
            Self::Request => "request",
        }
    }
}

/// The result of reading everything again.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Reloaded")]
pub struct Done {
    /// The tables; files of keys are among what was refused.
    #[serde(flatten)]
    pub tables: Reload,
    /// The number of valid keys, where they were read.
    pub keys: Option<usize>,
}

/// The longest time that reading may take: a file system may hang.
const PATIENCE: Duration = Duration::from_secs(30);

pub struct Reloader {
    service: Arc<Service>,
    gate: Arc<Gate>,
    tls: Option<Tls>,
    watched: Watched,
    /// The fingerprint of the files before they were read for the first time.
    first: Fingerprint,
    metrics: Metrics,
    is_reading: Arc<AtomicBool>,
    last: Mutex<Done>,
}

impl Reloader {
    /// For a service, a gate with its keys, and certificates, all read from files after `first` was taken.
    pub(super) fn new(
        service: Arc<Service>,
        gate: Arc<Gate>,
        tls: Option<Tls>,
        (watched, first): (Watched, Fingerprint),
        metrics: Metrics,
    ) -> Self {
        Self {
            service,
            gate,
            tls,
            watched,
            first,
            metrics,
            is_reading: Arc::default(),
            last: Mutex::default(),
        }
    }

    pub(super) fn has_files(&self) -> bool {
        !self.watched.is_empty()
    }

    pub async fn reload(&self, cause: Cause) -> Result<Done, Error> {
        let mut last = self.last.lock().await;
        let (service, gate, tls) = (self.service.clone(), self.gate.clone(), self.tls.clone());
        let watched = self.watched.clone();
        let read = move || {
            let keys = gate.settings().has_keys().then(|| gate.reload());
            let certificates = tls.map(|tls| tls.reload());
            let tables = service.read_tables(watched.config());
            (tables, keys, certificates)
        };
        let (tables, keys, certificates) = self.read(read).await?;
        let mut done = Done {
            tables: self.service.serve_tables(tables).await,
            keys: None,
        };
        match keys {
            Some(Ok(count)) => done.keys = Some(count),
            Some(Err(error)) => {
                let file = self.gate.settings().keys_file();
                let file = file.or(Some(Path::new("access.keys")));
                done.tables.refuse_file(file, &error);
            }
            None => {}
        }
        match certificates {
            Some(Ok(true)) => tracing::info!("the certificates were replaced"),
            Some(Err(error)) => done.tables.refuse_file(Some(error.path()), &error),
            _ => {}
        }
        // A look that finds the same damaged file again is no news.
        let is_news = cause != Cause::Change || differs(&last, &done);
        if is_news {
            log(cause, &done, &self.metrics);
        }
        *last = done.clone();
        Ok(done)
    }

    /// Reloads on signals and changes until it is dropped. Without `every`, changes are not looked for.
    pub async fn watch(&self, mut hangups: Option<Hangups>, every: Option<Duration>) {
        let mut seen = self.first;
        loop {
            let signal = OptionFuture::from(hangups.as_mut().map(Hangups::next));
            let change = OptionFuture::from(every.map(sleep));
            let cause = tokio::select! {
                Some(()) = signal => Cause::Signal,
                Some(()) = change => Cause::Change,
                else => return,
            };
            let now = match self.look().await {
                Ok(now) => now,
                Err(error) => {
                    tracing::error!(%error, "files cannot be looked at");
                    continue;
                }
            };
            if cause == Cause::Change && now == seen {
                continue;
            }
            seen = now;
            if let Err(error) = self.reload(cause).await {
                tracing::error!(%error, "files were not read again");
            }
        }
    }

    async fn look(&self) -> Result<Fingerprint, Error> {
        let watched = self.watched.clone();
        self.read(move || watched.look()).await
    }

    /// Reads files on a thread that may block, and waits for a limited time. A file system that hangs
    /// keeps one such thread, however often it is tried.
    async fn read<T: Send + 'static>(
        &self,
        read: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, Error> {
        const HANGS: Error = Error::Internal("a file system does not answer");
        let is_reading = self.is_reading.clone();
        if is_reading.swap(true, Ordering::AcqRel) {
            return Err(HANGS);
        }
        let read = tokio::task::spawn_blocking(move || {
            let _reading = Reading(is_reading);
            read()
        });
        let read = timeout(PATIENCE, read).await;
        let read = read.map_err(|_| HANGS)?;
        read.map_err(|_| Error::Internal("the files cannot be read again"))
    }
}

/// Files are being read, until dropped.
struct Reading(Arc<AtomicBool>);

impl Drop for Reading {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Release);
    }
}

/// Whether a reload did or found anything that the one before did not.
fn differs(before: &Done, now: &Done) -> bool {
    let tables = &now.tables;
    let has_changed = !tables.loaded.is_empty()
        || !tables.removed.is_empty()
        || tables.fields.is_any()
        || tables.worlds.is_any()
        || tables.except.is_any();
    has_changed
        || tables.refused != before.tables.refused
        || tables.at_next_start != before.tables.at_next_start
        || now.keys != before.keys
}

fn log(cause: Cause, done: &Done, metrics: &Metrics) {
    let reload = &done.tables;
    let cause = cause.name();
    metrics.reloads.with_label_values(&[cause]).inc();
    for table in &reload.loaded {
        tracing::info!(
            cause,
            source = table.source,
            profile = table.profile,
            alpha = table.alpha,
            map = table.map,
            digest = table.digest,
            replaces = table.replaces,
            "table loaded"
        );
    }
    for table in &reload.removed {
        tracing::warn!(
            cause,
            source = table.source,
            digest = table.digest,
            "table removed: no file holds it any more"
        );
    }
    let kinds = [
        ("field", &reload.fields),
        ("list", &reload.except),
        ("world", &reload.worlds),
    ];
    for (kind, changes) in kinds {
        for name in &changes.loaded {
            tracing::info!(cause, name, "{kind} loaded");
        }
        for name in &changes.removed {
            tracing::warn!(cause, name, "{kind} removed: nothing describes it any more");
        }
    }
    for refusal in &reload.refused {
        metrics.refused_tables.inc();
        tracing::error!(
            cause,
            source = refusal.source,
            serving = refusal.serving,
            "reload refused; the previous version stays in use as far as its files are still there: {}",
            refusal.detail
        );
    }
    if let [others @ .., last] = &reload.at_next_start[..] {
        let (names, take) = match others {
            [] => (last.clone(), "it takes"),
            _ => (format!("{} and {last}", others.join(", ")), "they take"),
        };
        tracing::warn!(cause, "{names} changed; {take} effect at the next start");
    }
    if done.keys == Some(0) {
        tracing::error!(
            cause,
            "no key is valid: access.keys_file is gone or holds none, and requests that need a key are refused"
        );
    }
    tracing::info!(
        cause,
        loaded = reload.loaded.len(),
        kept = reload.kept.len(),
        removed = reload.removed.len(),
        refused = reload.refused.len(),
        tables = reload.tables,
        keys = done.keys,
        "tables read again"
    );
}

pub(super) fn endpoint(reloader: Arc<Reloader>) -> Endpoint {
    let operation = Operation {
        method: Method::POST,
        id: "reloadTables",
        summary: "Read tables and keys again",
        about: "For administrators: takes a key with admin = true, or the address of admin.listen. \
                Valid files are served from then on. An invalid file is refused, and its previous \
                content stays in use. Current answers are completed from the tables they began with.",
        problems: vec![Kind::NotAllowed],
        example: "/v1/tables:reload -X POST".into(),
        ..Operation::new(Tag::Operations, vec![Answer::json::<Done>("The result.")])
    };
    Endpoint::only("/v1/tables:reload", reloader, operation, reload)
}

async fn reload(
    State(reloader): State<Arc<Reloader>>,
    context: Context,
) -> Result<Response, Refused> {
    context.caller.must_be_admin()?;
    let reload = reloader.reload(Cause::Request).await?;
    Ok(json(&reload)?)
}
