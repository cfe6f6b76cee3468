//! `/metrics`: requests, points and bytes are counted exactly, and the number of samples is
//! bounded.

use strew::grpc::proto::point_service_client::PointServiceClient;
use strew_testkit::{http1, wait::until};

use crate::support::{
    daemon::Daemon,
    grpc::{LONG, collect, square},
    metrics::{samples, sum},
    queries::long,
};

const POINTS: &str = "/v1/points?bbox=0,0,20,20&density=1&profile=test&format=";

#[test]
fn requests_points_and_bytes_are_counted_by_protocol_and_format() {
    let daemon = Daemon::start(&[]);
    let csv = daemon.get(&format!("{POINTS}csv"));
    let packed = daemon.get(&format!("{POINTS}f32"));
    let long = daemon.get("/v1/points?bbox=0,0,700,700&density=1&profile=test&format=f64");
    let count: f64 = csv.header("strew-count").parse().expect("a number");
    let many: f64 = long.header("strew-count").parse().expect("a number");
    for _ in 0..2 {
        assert_eq!(daemon.get("/v1/points?bbox=0,0,0,0").status, 400);
    }
    assert_eq!(daemon.post("/v1/points", &().into()).status, 405);
    daemon.get("/nothing/1");
    daemon.get("/nothing/2");
    let samples = until("the last answer is counted", || {
        let samples = samples(&daemon);
        let none = sum(&samples, "strew_requests_total", &["route=\"none\""]);
        (none == 2.0).then_some(samples)
    });
    let of = |name: &str, labels: &[&str]| sum(&samples, name, labels);
    let points = "strew_points_total";
    assert_eq!(of(points, &["rest", "format=\"csv\""]), count);
    assert_eq!(of(points, &["rest", "format=\"f32\""]), count);
    assert_eq!(of(points, &["rest", "format=\"f64\""]), many);
    let bytes = "strew_response_bytes_total";
    assert_eq!(of(bytes, &["format=\"csv\""]), csv.body.len() as f64);
    assert_eq!(of(bytes, &["format=\"f32\""]), packed.body.len() as f64);
    let requests = "strew_requests_total";
    let route = "route=\"/v1/points\"";
    assert_eq!(of(requests, &[route, "method=\"POST\""]), 1.0);
    assert_eq!(
        of(requests, &[route, "method=\"GET\"", "status=\"2xx\""]),
        3.0
    );
    assert_eq!(of(requests, &[route, "status=\"4xx\""]), 3.0);
    assert_eq!(
        of(
            "strew_rejected_total",
            &["rest", "reason=\"invalid-query\""]
        ),
        2.0
    );
    assert_eq!(
        of("strew_rejected_total", &["reason=\"no-such-path\""]),
        2.0
    );
    assert_eq!(of("strew_broken_total", &[]), 0.0);
    for histogram in [
        "strew_request_duration_seconds",
        "strew_time_to_first_byte_seconds",
    ] {
        let labels = ["rest", "format=\"csv\""];
        assert_eq!(of(&format!("{histogram}_count"), &labels), 1.0);
        assert!(of(&format!("{histogram}_sum"), &labels) > 0.0);
        let all = [labels[0], labels[1], "le=\"+Inf\""];
        assert_eq!(of(&format!("{histogram}_bucket"), &all), 1.0);
    }
    // The request for the metrics itself.
    assert_eq!(of("strew_requests_in_flight", &["rest"]), 1.0);
    assert_eq!(of("strew_sampler_cache_misses_total", &[]), 1.0);
    assert_eq!(of("strew_sampler_cache_hits_total", &[]), 2.0);
    assert!(of("strew_sampler_cache_bytes", &[]) > 1000.0);
}

#[tokio::test(flavor = "multi_thread")]
async fn calls_are_counted_by_method_and_code() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let whole = collect(&mut client, square(300.0)).await;
    let status = client.stream_points(square(-1.0)).await.expect_err("empty");
    assert_eq!(status.code(), tonic::Code::InvalidArgument);
    // Over gRPC-Web, too, where the code is in the body.
    let empty_call = [("content-type", "application/grpc-web+proto")];
    let path = "/strew.v1.PointService/CountPoints";
    http1::post(daemon.address(), path, &empty_call, &[0; 5]);
    let samples = until("the calls are counted", || {
        let samples = samples(&daemon);
        let all = sum(&samples, "strew_requests_total", &["protocol=\"grpc\""]);
        (all == 3.0).then_some(samples)
    });
    let of = |name: &str, labels: &[&str]| sum(&samples, name, labels);
    let stream = "route=\"/strew.v1.PointService/StreamPoints\"";
    assert_eq!(of("strew_requests_total", &[stream, "status=\"OK\""]), 1.0);
    let invalid = "status=\"INVALID_ARGUMENT\"";
    assert_eq!(of("strew_requests_total", &[stream, invalid]), 1.0);
    let count = "route=\"/strew.v1.PointService/CountPoints\"";
    assert_eq!(of("strew_requests_total", &[count, invalid]), 1.0);
    let points = of("strew_points_total", &["grpc", "format=\"points\""]);
    assert_eq!(points, whole.header.count as f64);
    let reason = ["grpc", "reason=\"invalid-query\""];
    assert_eq!(of("strew_rejected_total", &reason), 2.0);
}

#[test]
fn made_up_names_add_few_samples() {
    let daemon = Daemon::start(&[]);
    let ask = |i: u32| {
        let method = format!("M{i}");
        http1::request(daemon.address(), &method, &format!("/x/{i}"), &[]);
        http1::request(daemon.address(), "GET", &format!("/v1/points/{i}:{i}"), &[]);
        let call = [("content-type", "application/grpc-web+proto")];
        let path = format!("/strew.v1.PointService/Method{i}");
        http1::open_post(daemon.address(), &path, &call, &[0; 5]).drain();
    };
    ask(0);
    let before = samples(&daemon).len();
    (1..30).for_each(ask);
    let after = samples(&daemon).len();
    assert!(after <= before + 2, "{before} samples became {after}");
}

#[test]
fn broken_answers_are_counted_apart() {
    let daemon = Daemon::start(&[]);
    let long = "/v1/points?bbox=0,0,20000,20000&density=1&profile=test&format=f32";
    let mut reader = http1::open(daemon.address(), "GET", long, &[]);
    assert!(reader.skip(1).expect("a byte") > 0);
    assert_eq!(sum(&samples(&daemon), "strew_streams_in_flight", &[]), 1.0);
    drop(reader);
    let samples = until("the broken answer is counted", || {
        let samples = samples(&daemon);
        let gone = sum(&samples, "strew_broken_total", &["by=\"client\""]);
        (gone == 1.0).then_some(samples)
    });
    // The points made until then are counted, and no more.
    let points = sum(&samples, "strew_points_total", &["format=\"f32\""]);
    assert!(points > 0.0 && points < 3e8, "{points}");
}

#[tokio::test(flavor = "multi_thread")]
async fn points_in_flight_rise_with_answers_and_return_to_zero() {
    let daemon = Daemon::start(&[]);
    let now = || sum(&samples(&daemon), "strew_points_in_flight", &[]);
    let until_none = |what: &str| until(what, || now() == 0.0);
    let path = long("f32");
    // A head has no points.
    let head = http1::request(daemon.address(), "HEAD", &path, &[]);
    let count: f64 = head.header("strew-count").parse().expect("a number");
    assert_eq!((head.status, now()), (200, 0.0));

    let read_a_byte = || {
        let mut reader = http1::open(daemon.address(), "GET", &path, &[]);
        assert!(reader.skip(1).expect("a byte") > 0);
        reader
    };
    // Sockets hold a few megabytes, so nearly all points are still to be made.
    let first = read_a_byte();
    assert!(
        (0.95 * count..count).contains(&now()),
        "{} of {count}",
        now()
    );
    let second = read_a_byte();
    assert!((1.9 * count..2.0 * count).contains(&now()), "{}", now());
    drop(first);
    until("one reader is gone", || now() < count);
    assert!(now() > 0.95 * count, "{} of {count}", now());
    drop(second);
    until_none("both readers are gone");

    let mut client = PointServiceClient::new(daemon.channel().await);
    let call = client.stream_points(square(LONG)).await;
    let mut stream = call.expect("a stream").into_inner();
    assert!(stream.message().await.expect("whole").is_some());
    assert!(
        (0.95 * count..=count).contains(&now()),
        "{} of {count}",
        now()
    );
    drop(stream);
    until_none("the call is canceled");

    // Answers that are read to their end leave nothing either; nor do those made at once, or refused.
    collect(&mut client, square(300.0)).await;
    daemon.get(&format!("{POINTS}csv"));
    daemon.get("/v1/points?bbox=0,0,300,300&density=1&profile=test&format=png");
    daemon.get("/v1/points?bbox=0,0,1e6,1e6&density=1&profile=test&format=csv");
    daemon.get("/v1/pattern/arrangements?offsets=1,0&bbox=0,0,300,300");
    until_none("all answers are read");
}

#[test]
fn tables_version_and_process_are_exported() {
    let daemon = Daemon::start(&["tables.embedded=false"]);
    let samples = samples(&daemon);
    let tables: Vec<_> = samples
        .keys()
        .filter(|k| k.starts_with("strew_table_info{"))
        .collect();
    assert_eq!(tables.len(), 2);
    assert!(
        tables
            .iter()
            .all(|t| t.contains("profile=\"test\"") && t.contains("digest=\""))
    );
    let version = format!("version=\"{}\"", env!("CARGO_PKG_VERSION"));
    assert_eq!(sum(&samples, "strew_build_info", &[&version]), 1.0);
    if cfg!(target_os = "linux") {
        let memory = sum(&samples, "process_resident_memory_bytes", &[]) / 1024.0;
        let seen = daemon.memory_kib("VmRSS") as f64;
        assert!((memory / seen - 1.0).abs() < 0.2, "{memory} and {seen}");
        assert!(sum(&samples, "process_cpu_seconds_total", &[]) >= 0.0);
    }
    let started = sum(&samples, "process_start_time_seconds", &[]);
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    assert!((now.expect("after 1970").as_secs_f64() - started).abs() < 600.0);
}

#[test]
fn metrics_can_be_switched_off() {
    let daemon = Daemon::start(&["metrics.enabled=false"]);
    assert_eq!(daemon.get("/metrics").status, 404);
}

#[test]
fn reloads_are_counted() {
    let daemon = Daemon::start(&[]);
    daemon.signal("HUP");
    until("the signal is counted", || {
        let labels = ["cause=\"signal\""];
        let reloads = sum(&samples(&daemon), "strew_tables_reloads_total", &labels);
        reloads == 1.0
    });
}
