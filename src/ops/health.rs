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
use strew_error::Error;
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

    /// Not ready from now on.
    pub fn close(&self) {
        self.is_closed.store(true, Ordering::Release);
    }

    /// Whether requests are welcome.
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

/// `/livez` and `/readyz`.
pub fn endpoints(readiness: Readiness, service: Arc<Service>) -> Vec<Endpoint> {
    let alive = operation::<Alive>(
        "getLivez",
        "Whether the daemon lives",
        &[(200, "It lives.")],
        "/livez",
    );
    let is_ready = operation::<Ready>(
        "getReadyz",
        "Whether the daemon takes requests",
        &[
            (200, "It takes requests."),
            (
                503,
                "It is about to stop, or points wait too long for a worker.",
            ),
        ],
        "/readyz",
    );
    vec![
        Endpoint::only("/livez", (), alive, live).open(),
        Endpoint::only("/readyz", (readiness, service), is_ready, ready).open(),
    ]
}

fn operation<T: JsonSchema>(
    id: &'static str,
    summary: &'static str,
    answers: &[(u16, &'static str)],
    path: &str,
) -> Operation {
    let answer = |&(status, about)| Answer {
        status,
        ..Answer::json::<T>(about)
    };
    Operation {
        id,
        summary,
        about: "For probes; never cached.",
        problems: vec![],
        example: path.into(),
        ..Operation::new(Tag::Operations, answers.iter().map(answer).collect())
    }
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
    /// The number of tables that are loaded.
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
    let status = if ready {
        StatusCode::OK
    } else {
        StatusCode::SERVICE_UNAVAILABLE
    };
    let state = Ready {
        ready,
        tables: {
            let catalog = service.catalog();
            catalog.entries().chain(catalog.in_space()).count()
        },
        streams: service.streams().open(),
    };
    Ok(momentary(status, &state)?)
}

fn momentary(status: StatusCode, value: &impl Serialize) -> Result<Response, Error> {
    let mut response = rest::momentary(rest::json(value)?);
    *response.status_mut() = status;
    Ok(response)
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
