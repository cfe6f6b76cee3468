//! Whether the daemon lives, and whether it takes requests.

use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

use axum::extract::State;
use http::StatusCode;
use schemars::JsonSchema;
use serde::Serialize;
use strew_service::{Pulse, Service, Workers};
use tokio::sync::watch;

use crate::{
    body::Response,
    grpc::Health,
    rest::{
        self, Context, Refused,
        api::{Answer, Endpoint, Operation, Tag},
    },
};

/// Whether requests are welcome: until the daemon stops, while its workers answer in time.
#[derive(Clone, Debug)]
pub struct Readiness {
    is_closed: Arc<AtomicBool>,
    pulse: Arc<Pulse>,
    bound: Duration,
}

impl Readiness {
    /// Ready from now on, while short work waits for no longer than `bound`.
    pub fn within(bound: Duration) -> Self {
        Self {
            is_closed: Arc::default(),
            pulse: Arc::default(),
            bound,
        }
    }

    pub fn close(&self) {
        self.is_closed.store(true, Ordering::Release);
    }

    pub fn is_ready(&self) -> bool {
        !self.is_closed.load(Ordering::Acquire) && self.pulse.is_within(self.bound)
    }

    /// Looks at the workers until the task is dropped, and reports to the health service of gRPC.
    pub async fn watch(self, workers: Workers, grpc: Health) {
        let (sender, mut in_time) = watch::channel(true);
        let report = async {
            while in_time.changed().await.is_ok() {
                let is_ready = *in_time.borrow_and_update();
                match is_ready {
                    true => tracing::info!("short work is done in time again"),
                    false => tracing::error!("short work waits too long: the daemon is not ready"),
                }
                if !self.is_closed.load(Ordering::Acquire) {
                    grpc.set(is_ready).await;
                }
            }
        };
        tokio::join!(self.pulse.beat(workers, self.bound, sender), report);
    }
}

pub fn endpoints(readiness: Readiness, service: Arc<Service>) -> Vec<Endpoint> {
    let lives = vec![Answer::json::<Alive>("It lives.")];
    let takes = Answer::json::<Ready>("It takes requests.");
    let about = "It is about to stop, or points wait too long for a worker.";
    let takes_none = Answer {
        status: 503,
        about,
        ..takes.clone()
    };
    let of = |id, summary, answers| Operation {
        id,
        summary,
        about: "For probes; never cached.",
        problems: vec![],
        ..Operation::new(Tag::Operations, answers)
    };
    let alive = of("getLivez", "Whether the daemon lives", lives);
    let summary = "Whether the daemon takes requests";
    let is_ready = of("getReadyz", summary, vec![takes, takes_none]);
    vec![
        Endpoint::only("/livez", (), alive, live).open(),
        Endpoint::only("/readyz", (readiness, service), is_ready, ready).open(),
    ]
}

/// That the daemon lives.
#[derive(Serialize, JsonSchema)]
struct Alive {
    /// Always true.
    alive: bool,
}

/// Whether the daemon takes requests.
#[derive(Serialize, JsonSchema)]
struct Ready {
    /// Whether it takes requests.
    ready: bool,
    /// The number of tables that are loaded now.
    tables: usize,
    /// The number of current streams.
    streams: usize,
}

/// [`Alive`] as a document.
const ALIVE: &str = "{\"alive\":true}\n";

async fn live(_: Context) -> Result<Response, Refused> {
    Ok(rest::momentary(rest::file(ALIVE, rest::JSON)))
}

async fn ready(
    State((readiness, service)): State<(Readiness, Arc<Service>)>,
    _: Context,
) -> Result<Response, Refused> {
    let ready = readiness.is_ready();
    let mut response = rest::json(&Ready {
        ready,
        tables: service.catalog().tables().len(),
        streams: service.streams().open(),
    })?;
    if !ready {
        *response.status_mut() = StatusCode::SERVICE_UNAVAILABLE;
    }
    Ok(rest::momentary(response))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_what_is_described() {
        let written = serde_json::to_string(&Alive { alive: true });
        assert_eq!(ALIVE.trim_end(), written.expect("a document"));
    }
}
