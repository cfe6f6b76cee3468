//! Limits on points, rows, streams, requests, bodies and memory: each refuses before the first byte
//! and names the limit.

use std::{
    io::{Read as _, Write as _},
    net::TcpStream,
};

use serde_json::{Value, json};
use strew::grpc::proto::{
    StreamPointsRequest, point_service_client::PointServiceClient, point_set::Amount,
};
use strew_core::{PointSet, Region};
use strew_testkit::{
    http1::{self, read_to_close},
    wait::until,
};
use tonic::Code;
use tonic_types::StatusExt as _;

use crate::support::{
    daemon::{Daemon, PROFILE, table},
    grpc::{boxed, set},
    problem::assert_fault,
    queries::{MANY_ROWS, SLOW, long},
};

/// The exact count of a box around the origin at density 1.
fn count(half: f64) -> u128 {
    let set = PointSet::new(table("(5-sqrt(3))/2", PROFILE));
    let region = Region::new([-half, -half], [half, half]).expect("a box");
    set.count(region).expect("near")
}

#[tokio::test]
async fn too_many_points_are_refused_with_the_exact_count_and_the_limit() {
    let daemon = Daemon::start(&["limits.max_points=1000"]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    // The last one holds more points than fit into 64 bits.
    for half in [20.0, 1e5, 1e14] {
        let (count, path) = (
            count(half).to_string(),
            format!("/v1/points?bbox=-{half},-{half},{half},{half}&density=1&profile=test"),
        );
        let answer = daemon.get(&path);
        assert_eq!(answer.status, 413, "{}", answer.text());
        assert_eq!(answer.header("content-type"), "application/problem+json");
        let shown = &answer.json()["count"];
        let shown = shown.as_str().map_or_else(|| shown.to_string(), Into::into);
        assert_eq!(shown, count);
        assert!(answer.text().contains("\"limit\":1000"));

        let request = StreamPointsRequest {
            region: boxed([-half, -half, half, half]),
            set: set(Amount::Spacing(1.0)),
            ..StreamPointsRequest::default()
        };
        let status = client.stream_points(request).await.expect_err("too many");
        assert_eq!(status.code(), Code::ResourceExhausted);
        assert!(status.message().contains(&count) && status.message().contains("1000"));
        let details = status.get_error_details();
        let info = details.error_info().expect("details");
        assert_eq!(
            (info.reason.as_str(), info.domain.as_str()),
            ("TOO_MANY_POINTS", "strew")
        );
        assert_eq!(info.metadata["count"], count);
        assert_eq!(info.metadata["limit"], "1000");
        assert_eq!(
            details.quota_failure().expect("details").violations.len(),
            1
        );
    }
    let fits = daemon.get("/v1/points?bbox=-15,-15,15,15&density=1&profile=test");
    assert_eq!(fits.status, 200);
}

#[test]
fn too_many_streams_are_refused_with_a_time_to_retry() {
    let daemon = Daemon::start(&["limits.max_streams=2"]);
    let path = long("f32");
    let open = || http1::open(daemon.address(), "GET", &path, &[]);
    let (first, second) = (open(), open());
    assert_eq!((first.status, second.status), (200, 200));
    let third = daemon.get(&path);
    assert_eq!(third.status, 503, "{}", third.text());
    assert_eq!(third.header("retry-after"), "1");
    assert_eq!(third.json()["limit"], 2);
    drop(first);
    until("there is room again", || open().status == 200);
}

#[test]
fn request_heads_are_bounded_in_size_and_time() {
    let daemon = Daemon::start(&[
        "server.max_header_bytes=8192",
        "server.header_read_timeout_seconds=0.2",
    ]);
    let long = format!("/v1/points?bbox={}", "1".repeat(9000));
    let answer = http1::open(daemon.address(), "GET", &long, &[]);
    assert!((414..=431).contains(&answer.status), "{}", answer.status);

    let mut slow = http1::connect(daemon.address()).expect("connected");
    slow.write_all(b"GET /livez HTTP/1.1\r\nhost")
        .expect("sent");
    // The daemon closes the connection, with or without an answer.
    assert!(!read_to_close(slow).starts_with("HTTP/1.1 200"));
}

#[test]
fn bodies_are_read_up_to_a_limit() {
    let daemon = Daemon::start(&["limits.max_body_bytes=2000"]);
    let body = |bytes: usize| {
        let query = r#"{ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1 }"#;
        format!("{query:<bytes$}").into_bytes()
    };
    for path in ["/v1/points:query", "/v1/count", "/v1/points:split?parts=2"] {
        assert_eq!(
            http1::post(daemon.address(), path, &[], &body(2000)).status,
            200
        );
        let refused = http1::post(daemon.address(), path, &[], &body(2001));
        check_refusal(&refused.json());
        assert_eq!(refused.header("content-type"), "application/problem+json");
    }
    // A body that announces its length is refused before it is sent.
    let mut stream = announce(&daemon, "/v1/count", ("content-length", "100000000000"));
    let mut text = String::new();
    stream.read_to_string(&mut text).expect("an answer");
    assert!(text.starts_with("HTTP/1.1 413"), "{text}");
    // A chunked body is read as far as the limit.
    let mut stream = announce(&daemon, "/v1/count", ("transfer-encoding", "chunked"));
    let piece = String::from_utf8(body(1500)).expect("UTF-8");
    write!(stream, "5dc\r\n{piece}\r\n5dc\r\n{piece}\r\n").expect("sent");
    let text = read_to_close(stream);
    assert!(text.starts_with("HTTP/1.1 413"), "{text}");
    let problem = text.split("\r\n\r\n").nth(1).expect("a body");
    check_refusal(&serde_json::from_str(problem).expect("JSON"));
}

/// Sends the head of a POST with a header that announces a body.
fn announce(daemon: &Daemon, path: &str, header: (&str, &str)) -> TcpStream {
    http1::send(daemon.address(), "POST", path, &[header], None).expect("sent")
}

fn check_refusal(problem: &Value) {
    assert_eq!(problem["type"], "urn:strew:problem:body-too-large");
    assert_eq!(problem["status"], 413);
    assert_eq!(problem["limit"], 2000);
}

#[test]
fn queries_with_too_many_rows_are_refused_at_once() {
    let daemon = Daemon::start(&["limits.max_rows=1000", "limits.max_points=1000000"]);
    let ring = |ring: Value| json!({ "polygon": { "type": "Polygon", "coordinates": [ring] } });
    let stripes: Vec<Value> = (0..200)
        .map(|i| json!({ "bbox": [0, i, 40, i as f64 + 0.5] }))
        .collect();
    for region in [
        json!({ "circle": { "center": [0, 0], "radius": 100 } }),
        ring(json!([[0, 0], [2000, 0], [2000, 1], [0, 1]])),
        ring(json!([[0, 0], [1, 0], [1, 2000], [0, 2000]])),
        json!({ "include": stripes }),
    ] {
        let body = json!({ "region": region, "spacing": 1 });
        let answer = daemon.post("/v1/count", &body);
        assert_eq!(answer.status, 413, "{body}: {}", answer.text());
        assert_eq!(answer.json()["type"], "urn:strew:problem:too-many-rows");
        assert_eq!(answer.json()["limit"], 1000);
        let narrow = json!({ "region": region, "spacing": 40 });
        assert_eq!(daemon.post("/v1/count", &narrow).status, 200, "{narrow}");
    }
    // Points that keep clear of others are checked one by one.
    let layers = json!({ "region": { "bbox": [0, 0, 90, 90] }, "layers": [
        { "name": "a", "spacing": 1 },
        { "name": "b", "spacing": 1, "seed": 3, "warp": "off", "clear_of": { "a": 0.5 } },
    ] });
    let answer = daemon.post("/v1/count", &layers);
    assert_eq!(answer.json()["type"], "urn:strew:problem:too-many-rows");
    // A comb: few rows, but points near each of its many edges are compared with all edges.
    let tip = |i: u32| [f64::from(i) * 0.01, f64::from(i % 2) * 0.2];
    let comb: Vec<[f64; 2]> = (0..3000).map(tip).chain([[15.0, -1.0]]).collect();
    let other = Daemon::start(&["limits.max_rows=2000"]);
    let body = json!({ "region": ring(json!(comb)), "spacing": 1 });
    let answer = other.post("/v1/count", &body);
    assert_eq!(answer.json()["type"], "urn:strew:problem:too-many-rows");
    // No spacing puts points on a line, so the search for one must end somewhere.
    let line = json!({ "region": ring(json!([[0, 0], [9, 9], [18, 18]])), "count": 10 });
    assert_fault(
        &daemon.post("/v1/count", &line),
        "a line",
        "count",
        &["no area"],
    );
}

#[test]
fn too_many_requests_are_refused_with_a_time_to_retry_and_probes_are_not() {
    let daemon = Daemon::start(&[
        MANY_ROWS,
        "server.first_byte_seconds=3600",
        "limits.max_requests=2",
    ]);
    let mut slow = vec![];
    let small = "/v1/points?bbox=0,0,5,5&density=1&profile=test";
    let refused = until("two requests are in progress", || {
        // The small request may have taken the place of the slow one.
        let body = Some(SLOW.as_bytes());
        let sent = http1::send(daemon.address(), "POST", "/v1/count", &[], body);
        slow.push(sent.expect("sent"));
        let answer = daemon.get(small);
        (answer.status != 200).then_some(answer)
    });
    assert_eq!(refused.status, 503);
    assert_eq!(refused.header("retry-after"), "1");
    assert_eq!(refused.json()["limit"], 2);
    assert_eq!(daemon.get("/livez").status, 200);
    assert_eq!(daemon.get("/readyz").status, 200);
    drop(slow);
    until("there is room again", || daemon.get(small).status == 200);
}

#[test]
fn the_memory_of_bodies_and_streams_is_bounded() {
    // Room for the most that one request may need: 28 MB, of which a stream takes 3.
    let daemon = Daemon::start(&["limits.max_bytes_in_flight=28000000"]);
    let body = vec![b' '; 4_000_000];
    let announced = ("content-length", "4000000");
    let announce = || announce(&daemon, "/v1/points:query", announced);
    let waiting: Vec<TcpStream> = (0..5)
        .map(|_| {
            let mut stream = announce();
            stream.write_all(&body[1..]).expect("sent");
            stream
        })
        .collect();
    let path = long("f32");
    let open = || http1::open(daemon.address(), "GET", &path, &[]);
    let mut streams = vec![];
    let refused = until("no room is left", || {
        let opened = open();
        match opened.status {
            200 => {
                streams.push(opened);
                assert!(streams.len() < 16, "never refused");
                None
            }
            _ => Some(opened),
        }
    });
    assert_eq!(refused.status, 503);
    assert_eq!(refused.headers["retry-after"], "1");
    let (problem, _) = refused.finish();
    let problem: Value = serde_json::from_slice(&problem).expect("JSON");
    assert_eq!(problem["limit"], 28_000_000);
    // There is no room for a sixth body either: the daemon may hang up before it is sent.
    let mut sixth = announce();
    let _ = sixth.write_all(&body);
    let response = read_to_close(sixth);
    assert!(
        response.starts_with("HTTP/1.1 503") || response.is_empty(),
        "{response}"
    );
    for stream in &mut streams {
        assert!(stream.skip(1 << 16).expect("it goes on") > 0);
    }
    drop((waiting, streams));
    until("there is room for many", || {
        let all: Vec<_> = (0..6).map(|_| open()).collect();
        all.iter().all(|opened| opened.status == 200)
    });
}
