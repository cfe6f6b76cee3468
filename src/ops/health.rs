//! Whether the daemon lives, and whether it takes requests.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use axum::{Router, body::Body, extract::State, response::Response, routing::get};
use http::{HeaderValue, StatusCode, header};
use serde::Serialize;

use crate::service::Service;

/// Whether requests are welcome. Starts as yes.
#[derive(Clone, Debug)]
pub struct Readiness {
    ready: Arc<AtomicBool>,
}

impl Default for Readiness {
    fn default() -> Self {
        Self {
            ready: Arc::new(AtomicBool::new(true)),
        }
    }
}

impl Readiness {
    /// From now on: no.
    pub fn close(&self) {
        self.ready.store(false, Ordering::Release);
    }

    /// Whether requests are welcome.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        self.ready.load(Ordering::Acquire)
    }
}

/// `/livez` and `/readyz`.
pub fn routes(readiness: Readiness, service: Arc<Service>) -> Router {
    Router::new()
        .route(
            "/livez",
            get(|| async { json(StatusCode::OK, &Alive { alive: true }) }),
        )
        .route("/readyz", get(ready))
        .with_state((readiness, service))
}

#[derive(Serialize)]
struct Alive {
    alive: bool,
}

#[derive(Serialize)]
struct Ready {
    ready: bool,
    tables: usize,
    /// Answers under way.
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
        tables: service.catalog().entries().len(),
        streams: service.streams().open(),
    };
    json(status, &state)
}

fn json(status: StatusCode, value: &impl Serialize) -> Response {
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
