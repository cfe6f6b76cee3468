//! Reading tables again while the daemon serves: on SIGHUP, when the folder changes, when asked.
//!
//! The folder is looked at every few seconds rather than listened to: notices of changes do not come
//! through network volumes and the folders that orchestrators mount, and a look costs microseconds.
//!
//! Counters, for whoever collects them: `strew_tables_reloads_total` by what caused them, and
//! `strew_tables_refused_total`.

mod look;

use std::{path::PathBuf, sync::Arc, time::Duration};

use tokio::sync::Mutex;

use super::shutdown::Hangups;
use crate::service::{Error, Reload, Service};
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

/// Reads tables again.
#[derive(Debug)]
pub struct Reloader {
    service: Arc<Service>,
    folder: Option<PathBuf>,
    /// What came of it the last time.
    last: Mutex<Reload>,
}

impl Reloader {
    /// For a service and its folder of tables.
    #[must_use]
    pub fn new(service: Arc<Service>, folder: Option<PathBuf>) -> Self {
        Self {
            service,
            folder,
            last: Mutex::default(),
        }
    }

    /// Reads everything again; says in the log what came of it.
    ///
    /// # Errors
    /// [`Error::Internal`] if that panicked; then nothing has changed.
    pub async fn reload(&self, cause: Cause) -> Result<Reload, Error> {
        let mut last = self.last.lock().await;
        let reload = self.service.reload(self.folder.clone()).await?;
        // A look that finds the same damaged file again has nothing to tell.
        let is_news = cause != Cause::Change || differs(&last, &reload);
        if is_news {
            tell(cause, &reload);
        }
        *last = reload.clone();
        Ok(reload)
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
        let look = tokio::task::spawn_blocking(move || Look::at(folder.as_deref()));
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
fn differs(before: &Reload, now: &Reload) -> bool {
    !now.loaded.is_empty() || !now.removed.is_empty() || now.refused != before.refused
}

fn tell(cause: Cause, reload: &Reload) {
    let cause = cause.name();
    metrics::counter!("strew_tables_reloads_total", "cause" => cause).increment(1);
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
        metrics::counter!("strew_tables_refused_total").increment(1);
        tracing::error!(
            cause,
            source = refusal.source,
            serving = refusal.serving,
            "table refused, what was loaded serves on: {}",
            refusal.detail
        );
    }
    tracing::info!(
        cause,
        loaded = reload.loaded.len(),
        kept = reload.kept.len(),
        removed = reload.removed.len(),
        refused = reload.refused.len(),
        "tables read again"
    );
}
