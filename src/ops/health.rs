//! Whether the daemon lives, and whether it takes requests.

use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

use axum::{body::Body, extract::State, response::Response, routing::get};
use http::{HeaderValue, Method, StatusCode, header};
use schemars::JsonSchema;
use serde::Serialize;
use tokio::sync::watch;

use crate::{
    grpc::Health,
    rest::api::{Answer, Endpoint, Operation, Tag, schemas},
    service::{Pulse, Service, Workers},
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
    #[must_use]
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
    #[must_use]
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
    let alive = operation(
        "getLivez",
        "Whether the daemon lives",
        |generator| generator.subschema_for::<Alive>(),
        vec![(200, "It lives.")],
        "/livez",
    );
    let is_ready = operation(
        "getReadyz",
        "Whether the daemon takes requests",
        |generator| generator.subschema_for::<Ready>(),
        vec![
            (200, "It takes requests."),
            (
                503,
                "It is about to stop, or points wait too long for a worker.",
            ),
        ],
        "/readyz",
    );
    let live = get(|| async { typed(StatusCode::OK, &Alive { alive: true }) });
    vec![
        Endpoint::new("/livez", (), vec![(alive, live)]).open(),
        Endpoint::new(
            "/readyz",
            (readiness, service),
            vec![(is_ready, get(ready))],
        )
        .open(),
    ]
}

fn operation(
    id: &'static str,
    summary: &'static str,
    schema: schemas::Content,
    answers: Vec<(u16, &'static str)>,
    path: &str,
) -> Operation {
    Operation {
        method: Method::GET,
        id,
        summary,
        about: "For probes; never cached.",
        tag: Tag::Operations,
        path_parameters: &[],
        parameters: &[],
        body: None,
        answers: answers
            .into_iter()
            .map(|(status, about)| Answer {
                status,
                about,
                headers: vec![],
                contents: vec![("application/json", schema)],
            })
            .collect(),
        problems: vec![],
        example: path.into(),
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

async fn ready(State((readiness, service)): State<(Readiness, Arc<Service>)>) -> Response {
    let ready = readiness.is_ready();
    let status = if ready {
        StatusCode::OK
    } else {
        StatusCode::SERVICE_UNAVAILABLE
    };
    let state = Ready {
        ready,
        tables: service.catalog().entries().count(),
        streams: service.streams().open(),
    };
    typed(status, &state)
}

fn typed(status: StatusCode, value: &impl Serialize) -> Response {
    let mut body = serde_json::to_vec(value).unwrap_or_default();
    body.push(b'\n');
    let mut response = Response::new(Body::from(body));
    *response.status_mut() = status;
    let headers = response.headers_mut();
    headers.insert(
        header::CONTENT_TYPE,
        HeaderValue::from_static("application/json"),
    );
    // Probes want to know about now.
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    response
}
