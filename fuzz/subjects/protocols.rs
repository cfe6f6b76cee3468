//! The protocols of a daemon without a socket, and what every answer must be.

use std::sync::{Arc, LazyLock};

use axum::{Router, body::to_bytes};
use http::{StatusCode, Uri, header};
use http_body_util::BodyExt as _;
use strew::{
    body::{Body, Request, Response},
    grpc, rest,
};
use strew_catalog::Catalog;
use strew_config::{Layers, Limits};
use strew_service::access::Caller;
use strew_service::{Service, Workers};
use tokio::runtime::Runtime;
use tower::ServiceExt as _;

/// The most points of an answer here: what is fuzzed is asking.
pub const MOST_POINTS: u64 = 3000;
/// The most rows that are counted for one.
const MOST_ROWS: u64 = 20_000;
/// The most bytes of an answer that are looked at: a picture of the largest size.
const MOST_BYTES: usize = 256 << 20;

struct Protocols {
    runtime: Runtime,
    /// All paths of both. There is no gate: everyone is let in.
    router: Router,
}

static PROTOCOLS: LazyLock<Protocols> = LazyLock::new(|| {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .build()
        .expect("a runtime");
    let settings = Layers::new().and_then(Layers::finish).expect("in order");
    let limits = Limits {
        max_points: MOST_POINTS,
        max_rows: MOST_ROWS,
        ..settings.limits
    };
    let catalog = Catalog::load(true, None).expect("built in");
    let workers = Workers::new(1);
    let service = Arc::new(Service::new(catalog, limits, workers));
    let (grpc, _) = runtime
        .block_on(grpc::calls(service.clone()))
        .expect("built rightly");
    let pages = rest::Pages::default();
    let routes = rest::Routes::new(rest::endpoints(&service), &[], &pages, "");
    let rest::Routes { gated, open, paths } = routes;
    let nothing = async move |uri: Uri| paths.nothing(uri.path());
    let router = gated.merge(open).merge(grpc.contract).fallback(nothing);
    Protocols { runtime, router }
});

impl Protocols {
    async fn answer(&self, mut request: Request) -> Response {
        request.extensions_mut().insert(Caller::default());
        let answered = self.router.clone().oneshot(request).await;
        answered.unwrap_or_else(|never| match never {})
    }
}

/// An answer, read to its end.
pub struct Answered {
    pub head: http::response::Parts,
    pub body: Vec<u8>,
}

impl Answered {
    pub fn header(&self, name: &str) -> Option<&str> {
        self.head.headers.get(name)?.to_str().ok()
    }
}

/// Asks by REST. The answer is one that may be, or this panics.
pub fn ask(request: Request) -> Answered {
    let protocols = &*PROTOCOLS;
    let answered = protocols.runtime.block_on(async {
        let (head, body) = protocols.answer(request).await.into_parts();
        let body = to_bytes(body, MOST_BYTES).await;
        let body = body.expect("an answer ends as it should").to_vec();
        Answered { head, body }
    });
    check(&answered);
    answered
}

fn check(answered: &Answered) {
    let Answered { head, body } = answered;
    let content = answered.header(header::CONTENT_TYPE.as_str());
    match head.status {
        StatusCode::OK => {}
        StatusCode::NOT_MODIFIED | StatusCode::METHOD_NOT_ALLOWED => return,
        status if status.is_client_error() => {
            assert_eq!(content, Some("application/problem+json"), "{status}");
            let problem: serde_json::Value = serde_json::from_slice(body).expect("JSON");
            assert!(problem["detail"].is_string(), "{problem}");
            return;
        }
        status => panic!("{status}: {}", String::from_utf8_lossy(body)),
    }
    let Some(count) = answered
        .header("strew-count")
        .and_then(|c| c.parse::<usize>().ok())
    else {
        return;
    };
    let lines = || body.iter().filter(|&&b| b == b'\n').count();
    match content.unwrap_or("") {
        // The last line is the summary.
        "application/x-ndjson" => assert_eq!(lines(), count + 1),
        text if text.starts_with("text/csv") => assert_eq!(lines(), count + 1),
        _ => {}
    }
}

/// Calls a method by gRPC with one message. Gives the status, as a number, with its message.
pub fn call(method: &str, message: &[u8]) -> (u32, String) {
    let protocols = &*PROTOCOLS;
    let mut frame = vec![0];
    frame.extend(u32::try_from(message.len()).expect("short").to_be_bytes());
    frame.extend(message);
    let request = http::Request::post(format!("/strew.v1.PointService/{method}"))
        .version(http::Version::HTTP_2)
        .header(header::CONTENT_TYPE, "application/grpc")
        .header(header::TE, "trailers")
        .body(Body::from(frame))
        .expect("a request");
    protocols.runtime.block_on(async {
        let (head, mut body) = protocols.answer(request).await.into_parts();
        let mut trailers = head.headers;
        while let Some(frame) = body.frame().await {
            if let Ok(more) = frame.expect("an answer ends as it should").into_trailers() {
                trailers.extend(more);
            }
        }
        let text = |name: &str| trailers.get(name).and_then(|v| v.to_str().ok());
        let status = text("grpc-status").and_then(|s| s.parse().ok());
        let message = text("grpc-message").unwrap_or("").to_owned();
        (status.expect("every call ends with a status"), message)
    })
}
