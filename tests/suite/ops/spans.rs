//! Spans of requests, as an OpenTelemetry collector receives them.

use std::{
    net::{SocketAddr, TcpListener},
    sync::mpsc,
    time::{Duration, Instant},
};

use opentelemetry_proto::tonic::{
    collector::trace::v1::{
        ExportTraceServiceRequest, ExportTraceServiceResponse,
        trace_service_server::{TraceService, TraceServiceServer},
    },
    common::v1::{KeyValue, any_value::Value},
    trace::v1::{Span, span::SpanKind, status::StatusCode},
};
use strew::grpc::proto::{ListProfilesRequest, point_service_client::PointServiceClient};
use strew_testkit::{
    certificates::Authority,
    http1,
    wait::{PATIENCE, until},
};
use tonic::{
    Request, Response, Status,
    transport::{Identity, Server, ServerTlsConfig, server::TcpIncoming},
};

use crate::support::{
    daemon::{Daemon, strew},
    metrics::{samples, sum},
};

/// A collector that passes on what it receives.
struct Collector {
    address: SocketAddr,
    got: mpsc::Receiver<ExportTraceServiceRequest>,
    _runtime: tokio::runtime::Runtime,
}

struct Passing(mpsc::Sender<ExportTraceServiceRequest>);

#[tonic::async_trait]
impl TraceService for Passing {
    async fn export(
        &self,
        request: Request<ExportTraceServiceRequest>,
    ) -> Result<Response<ExportTraceServiceResponse>, Status> {
        let passed = self.0.send(request.into_inner());
        passed.map_err(|_| Status::unavailable("no receiver"))?;
        Ok(Response::new(ExportTraceServiceResponse::default()))
    }
}

impl Collector {
    fn start(identity: Option<Identity>) -> Self {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .enable_all()
            .build()
            .expect("a runtime");
        let (sender, got) = mpsc::channel();
        let _entered = runtime.enter();
        let any = "127.0.0.1:0".parse().expect("an address");
        let incoming = TcpIncoming::bind(any).expect("a port");
        let address = incoming.local_addr().expect("bound");
        let mut server = Server::builder();
        if let Some(identity) = identity {
            let tls = ServerTlsConfig::new().identity(identity);
            server = server.tls_config(tls).expect("a certificate");
        }
        let service = TraceServiceServer::new(Passing(sender));
        runtime.spawn(server.add_service(service).serve_with_incoming(incoming));
        drop(_entered);
        Self {
            address,
            got,
            _runtime: runtime,
        }
    }

    /// The spans of the next message, each with the name of its service.
    fn next(&self) -> Vec<(String, Span)> {
        let message = self.got.recv_timeout(PATIENCE).expect("a message");
        let mut spans = vec![];
        for of_resource in message.resource_spans {
            let resource = of_resource.resource.expect("a resource");
            let service = text(&resource.attributes, "service.name");
            for of_scope in of_resource.scope_spans {
                let named = of_scope.spans.into_iter();
                spans.extend(named.map(|span| (service.clone(), span)));
            }
        }
        spans
    }
}

fn value(attributes: &[KeyValue], key: &str) -> Option<Value> {
    let found = attributes.iter().find(|pair| pair.key == key)?;
    found.value.as_ref()?.value.clone()
}

fn text(attributes: &[KeyValue], key: &str) -> String {
    match value(attributes, key) {
        Some(Value::StringValue(text)) => text,
        other => panic!("{key}: {other:?}"),
    }
}

fn number(attributes: &[KeyValue], key: &str) -> i64 {
    match value(attributes, key) {
        Some(Value::IntValue(number)) => number,
        other => panic!("{key}: {other:?}"),
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

const TRACE: &str = "4bf92f3577b34da6a3ce929d0e0e4736";
const PARENT: &str = "00f067aa0ba902b7";
const QUERY: &str = "bbox=0,0,10,10&spacing=1&format=csv";

#[tokio::test(flavor = "multi_thread")]
async fn requests_become_spans_of_their_traces() {
    let collector = tokio::task::spawn_blocking(|| Collector::start(None));
    let collector = collector.await.expect("started");
    let endpoint = format!("telemetry.otlp_endpoint=http://{}", collector.address);
    let mut daemon = Daemon::start(&[&endpoint, "telemetry.service_name=scatter"]);
    let points = format!("/v1/points?{QUERY}");
    let get = |path: &str, flags: &str| {
        let parent = format!("00-{TRACE}-{PARENT}-{flags}");
        let headers = [("traceparent", &*parent), ("x-request-id", "tile-7")];
        http1::get(daemon.address(), path, &headers)
    };
    // Neither an unsampled trace nor a probe is sent.
    assert_eq!(get(&points, "00").status, 200);
    assert_eq!(get("/readyz", "01").status, 200);
    let answer = get(&points, "01");
    assert_eq!(answer.status, 200);
    assert_eq!(daemon.get("/v1/points?bbox=0").status, 400);
    PointServiceClient::new(daemon.channel().await)
        .list_profiles(ListProfilesRequest {})
        .await
        .expect("an answer");
    // Stopping sends the spans in the queue.
    daemon.terminate();
    assert!(daemon.wait().success());
    let mut spans = vec![];
    while spans.len() < 3 {
        spans.extend(collector.next());
    }
    assert_eq!(spans.len(), 3, "{spans:#?}");
    assert!(collector.got.try_recv().is_err());
    assert!(spans.iter().all(|(service, _)| service == "scatter"));
    let named = |name: &str| {
        let found = spans.iter().find(|(_, span)| span.name == name);
        let span = &found.unwrap_or_else(|| panic!("no {name}: {spans:#?}")).1;
        assert_eq!(span.kind, SpanKind::Server as i32);
        assert!(span.end_time_unix_nano >= span.start_time_unix_nano);
        assert!(span.start_time_unix_nano > 1_700_000_000_000_000_000);
        span
    };

    let kept = spans.iter().find(|(_, span)| hex(&span.trace_id) == TRACE);
    let kept = &kept.expect("the client's trace").1;
    assert_eq!(kept.name, "GET /v1/points");
    assert_eq!(hex(&kept.parent_span_id), PARENT);
    assert!(kept.span_id.len() == 8 && hex(&kept.span_id) != PARENT);
    let of = |key| text(&kept.attributes, key);
    assert_eq!(of("strew.request_id"), "tile-7");
    assert_eq!(of("http.route"), "/v1/points");
    assert_eq!(of("url.path"), "/v1/points");
    assert_eq!(of("url.query"), QUERY);
    assert_eq!(of("strew.format"), "csv");
    assert_eq!(of("network.peer.address"), "127.0.0.1");
    let of = |key| number(&kept.attributes, key);
    assert_eq!(of("http.response.status_code"), 200);
    assert_eq!(of("http.response.body.size"), answer.body.len() as i64);
    let lines = answer.text().lines().count() as i64;
    assert_eq!(of("strew.points"), lines - 1);

    // Requests without a trace begin their own.
    let refused = spans.iter().find(|(_, span)| {
        value(&span.attributes, "http.response.status_code") == Some(Value::IntValue(400))
    });
    let refused = &refused.expect("the refusal").1;
    assert_eq!(text(&refused.attributes, "error.type"), "invalid-query");
    let call = named("strew.v1.PointService/ListProfiles");
    assert_eq!(text(&call.attributes, "rpc.method"), "ListProfiles");
    assert_eq!(number(&call.attributes, "rpc.grpc.status_code"), 0);
    for span in [refused, call] {
        assert!(span.parent_span_id.is_empty() || hex(&span.parent_span_id) == "0".repeat(16));
        assert_ne!(hex(&span.trace_id), TRACE);
        // An invalid request is not an error of the server.
        let status = span.status.as_ref().map_or(0, |status| status.code);
        assert_eq!(status, StatusCode::Unset as i32);
    }
    assert_ne!(refused.trace_id, call.trace_id);
    tokio::task::spawn_blocking(|| drop(collector))
        .await
        .expect("stopped");
}

#[test]
fn collectors_may_speak_tls() {
    let folder = tempfile::tempdir().expect("a folder");
    let authority = Authority::new();
    let issued = authority.issue_server();
    let collector = Collector::start(Some(Identity::from_pem(&issued.pem, &issued.key_pem)));
    let ca = folder.path().join("ca.pem");
    std::fs::write(&ca, authority.pem()).expect("writable");
    let endpoint = format!("telemetry.otlp_endpoint=https://{}", collector.address);
    let ca = format!("telemetry.otlp_ca={}", ca.display());
    let daemon = Daemon::start(&[&endpoint, &ca]);
    assert_eq!(daemon.get("/v1/profiles").status, 200);
    let spans = collector.next();
    assert_eq!(spans[0].0, "strew");
    assert_eq!(spans[0].1.name, "GET /v1/profiles");
    let sent = ["outcome=\"sent\""];
    until("the span is counted", || {
        sum(&samples(&daemon), "strew_spans_total", &sent) == 1.0
    });
}

#[test]
fn an_unresponsive_collector_delays_no_request() {
    // It accepts connections and never answers.
    let silent = TcpListener::bind("127.0.0.1:0").expect("a port");
    let endpoint = format!(
        "telemetry.otlp_endpoint=http://{}",
        silent.local_addr().expect("bound")
    );
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("log");
    let log = std::fs::File::create(&path).expect("writable");
    let settings = [
        &*endpoint,
        "telemetry.max_queued_spans=4",
        "telemetry.export_timeout_seconds=0.5",
        "log.filter=warn",
    ];
    let mut daemon = Daemon::logging_to(log, &settings);
    let start = Instant::now();
    let mut asked = 0.0;
    let lost = |daemon: &Daemon| sum(&samples(daemon), "strew_spans_total", &["outcome=\"lost\""]);
    // Spans in the queue are lost after the timeout, further ones at once.
    until("spans are lost", || {
        for _ in 0..20 {
            assert_eq!(daemon.get("/v1/profiles").status, 200);
            asked += 1.0;
        }
        lost(&daemon) >= 15.0
    });
    let each = start.elapsed().as_secs_f64() / asked;
    assert!(each < 0.5, "{each} seconds a request");
    assert!(
        sum(
            &samples(&daemon),
            "strew_spans_total",
            &["outcome=\"sent\""]
        ) == 0.0
    );
    let start = Instant::now();
    daemon.terminate();
    assert!(daemon.wait().success());
    assert!(start.elapsed() < Duration::from_secs(10));
    let log = std::fs::read_to_string(&path).expect("readable");
    assert!(
        log.contains("the collector takes spans slower than they come"),
        "{log}"
    );
    assert!(log.lines().count() < 10, "{log}");
}

#[test]
fn unusable_settings_are_named() {
    for (endpoint, ca, part) in [
        ("127.0.0.1:4317", "", "allowed: http://host:port"),
        ("ftp://a:1", "", "allowed: http://host:port"),
        ("http://a:1/v1/traces", "", "allowed: http://host:port"),
        ("https://a:1", "", "an authority with https"),
        ("http://a:1", "x", "an authority with https"),
        (
            "https://a:1",
            "/nowhere",
            "telemetry.otlp_ca = \"/nowhere\": it cannot be read",
        ),
        ("https://a:1", "Cargo.toml", "it holds no certificate"),
    ] {
        let output = strew()
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args(["serve", "--listen", "127.0.0.1:0"])
            .args(["--set", &format!("telemetry.otlp_endpoint={endpoint}")])
            .args(["--set", &format!("telemetry.otlp_ca={ca}")])
            .output()
            .expect("the program runs");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(part), "no `{part}`: {message}");
    }
}
