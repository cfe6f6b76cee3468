//! Whether the daemon lives, and whether it takes requests.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use axum::{body::Body, extract::State, response::Response, routing::get};
use http::{HeaderValue, Method, StatusCode, header};
use serde::Serialize;
use serde_json::{Value, json};

use crate::{
    rest::api::{Answer, Endpoint, Operation},
    service::Service,
};

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
pub fn endpoints(readiness: Readiness, service: Arc<Service>) -> Vec<Endpoint> {
    let alive = operation(
        "getLivez",
        "Whether the daemon lives",
        json!({ "alive": { "type": "boolean" } }),
        vec![(200, "It lives.")],
        "/livez",
    );
    let is_ready = operation(
        "getReadyz",
        "Whether the daemon takes requests",
        json!({
            "ready": { "type": "boolean" },
            "tables": { "type": "integer" },
            "streams": { "type": "integer" },
        }),
        vec![(200, "It takes requests."), (503, "It is about to stop.")],
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
    members: Value,
    answers: Vec<(u16, &'static str)>,
    path: &str,
) -> Operation {
    let required: Vec<&String> = members
        .as_object()
        .into_iter()
        .flatten()
        .map(|m| m.0)
        .collect();
    let schema = json!({ "type": "object", "required": required, "properties": members });
    Operation {
        method: Method::GET,
        id,
        summary,
        about: "For probes; never cached.",
        path_parameters: &[],
        parameters: vec![],
        body: None,
        answers: answers
            .into_iter()
            .map(|(status, about)| Answer {
                status,
                about,
                headers: vec![],
                contents: vec![("application/json".into(), schema.clone())],
            })
            .collect(),
        problems: vec![],
        example: path.into(),
    }
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
