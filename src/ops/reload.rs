//! Reading tables and keys again while the daemon serves: on SIGHUP, when files change,
//! when asked.
//!
//! The folder is looked at every few seconds rather than listened to: notices of changes do not come
//! through network volumes and the folders that orchestrators mount, and a look costs microseconds.
//!
//! Counters, for whoever collects them: `strew_tables_reloads_total` by what caused them, and
//! `strew_tables_refused_total`.

mod look;

use std::{path::PathBuf, sync::Arc, time::Duration};

use serde::Serialize;
use tokio::sync::Mutex;

use super::{metrics::Metrics, shutdown::Hangups};
use crate::{
    access::Gate,
    service::{Error, Reload, Service, catalog::Refusal},
};
use look::Look;

/// Why tables are read again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// SIGHUP.
    Signal,
    /// The folder looks different.
    Change,
    /// Somebody asked.
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

/// What came of reading everything again.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Done {
    /// The tables; files of keys are among what was refused.
    #[serde(flatten)]
    pub tables: Reload,
    /// How many keys are let in, where they were read.
    pub keys: Option<usize>,
}

/// Reads tables and keys again.
#[derive(Debug)]
pub struct Reloader {
    service: Arc<Service>,
    gate: Arc<Gate>,
    folder: Option<PathBuf>,
    metrics: Metrics,
    /// What came of it the last time.
    last: Mutex<Done>,
}

impl Reloader {
    /// For a service and its folder of tables, and a gate with its keys.
    pub(super) fn new(
        service: Arc<Service>,
        gate: Arc<Gate>,
        folder: Option<PathBuf>,
        metrics: Metrics,
    ) -> Self {
        Self {
            service,
            gate,
            folder,
            metrics,
            last: Mutex::default(),
        }
    }

    /// Reads everything again; says in the log what came of it.
    ///
    /// # Errors
    /// [`Error::Internal`] if that panicked; then nothing has changed.
    pub async fn reload(&self, cause: Cause) -> Result<Done, Error> {
        let mut last = self.last.lock().await;
        let tables = self.service.reload(self.folder.clone()).await?;
        let done = self.keys(tables).await?;
        // A look that finds the same damaged file again has nothing to tell.
        let is_news = cause != Cause::Change || differs(&last, &done);
        if is_news {
            tell(cause, &done, &self.metrics);
        }
        *last = done.clone();
        Ok(done)
    }

    /// Reads the keys again; a refusal goes to the others.
    async fn keys(&self, mut tables: Reload) -> Result<Done, Error> {
        if !self.gate.settings().has_keys() {
            return Ok(Done { tables, keys: None });
        }
        let gate = self.gate.clone();
        let read = tokio::task::spawn_blocking(move || gate.reload());
        let read = read
            .await
            .map_err(|_| Error::Internal("the keys cannot be read again"))?;
        let keys = match read {
            Ok(count) => Some(count),
            Err(error) => {
                let file = self.gate.settings().keys_file();
                let source = file.map_or("access.keys".into(), |file| file.display().to_string());
                tables.refused.push(Refusal {
                    source,
                    detail: error.to_string(),
                    serving: None,
                });
                None
            }
        };
        Ok(Done { tables, keys })
    }

    /// Reloads on signals and changes until it is dropped. Without `every` nobody looks for changes.
    pub async fn watch(&self, mut hangups: Option<Hangups>, every: Option<Duration>) {
        let mut seen = self.look().await;
        loop {
            let cause = tokio::select! {
                () = heard(&mut hangups) => Cause::Signal,
                () = wait(every) => Cause::Change,
            };
            let now = self.look().await;
            if cause == Cause::Change && now.is_surely(&seen) {
                continue;
            }
            seen = now;
            if let Err(error) = self.reload(cause).await {
                tracing::error!(%error, "the tables were not read again");
            }
        }
    }

    async fn look(&self) -> Look {
        let folder = self.folder.clone();
        let keys = self.gate.settings().keys_file().map(Into::into);
        let look = tokio::task::spawn_blocking(move || {
            let keys: Option<PathBuf> = keys;
            Look::at(folder.as_deref(), keys.as_deref())
        });
        look.await.unwrap_or_default()
    }
}

async fn heard(hangups: &mut Option<Hangups>) {
    match hangups {
        Some(hangups) => hangups.next().await,
        None => std::future::pending().await,
    }
}

async fn wait(every: Option<Duration>) {
    match every {
        Some(every) => tokio::time::sleep(every).await,
        None => std::future::pending().await,
    }
}

/// Whether a reload did or found anything that the one before did not.
fn differs(before: &Done, now: &Done) -> bool {
    let tables = &now.tables;
    let has_changed = !tables.loaded.is_empty() || !tables.removed.is_empty();
    has_changed || tables.refused != before.tables.refused || now.keys != before.keys
}

fn tell(cause: Cause, done: &Done, metrics: &Metrics) {
    let reload = &done.tables;
    let cause = cause.name();
    metrics.reloads(cause).increment(1);
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
    for refusal in &reload.refused {
        metrics.refused_tables().increment(1);
        tracing::error!(
            cause,
            source = refusal.source,
            serving = refusal.serving,
            "refused, what was loaded serves on: {}",
            refusal.detail
        );
    }
    tracing::info!(
        cause,
        loaded = reload.loaded.len(),
        kept = reload.kept.len(),
        removed = reload.removed.len(),
        refused = reload.refused.len(),
        keys = done.keys,
        "tables read again"
    );
}
