//! Timeouts: how long the daemon waits for bodies, plans, readers and whole answers.

use std::{
    fs,
    io::Write as _,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use strew::grpc::proto::{
    PointSet, StreamPointsRequest, point_service_client::PointServiceClient, point_set::Amount,
};
use strew_testkit::{
    http1::{self, read_to_close},
    wait::{PATIENCE, until},
};
use tonic::Code;
use tonic_types::StatusExt as _;

use crate::support::{
    daemon::{Daemon, PROFILE},
    grpc::{LONG, boxed, broken_off, square},
    queries::{MANY_ROWS, SLOW, long},
};

/// A daemon that may count for minutes.
fn patient(settings: &[&str]) -> Daemon {
    Daemon::start(&[&[MANY_ROWS], settings].concat())
}

/// Whether the daemon computes: it uses processor time without any request of ours.
fn is_busy(daemon: &Daemon) -> bool {
    // On a busy machine it does not get much.
    daemon.cpu_ticks_over(Duration::from_millis(500)) > 1
}

#[test]
fn a_body_that_does_not_arrive_times_out() {
    let daemon = Daemon::start(&["server.body_read_timeout_seconds=0.3"]);
    let announced = [("content-length", "100")];
    let mut slow = http1::send(
        daemon.address(),
        "POST",
        "/v1/points:query",
        &announced,
        None,
    )
    .expect("sent");
    slow.write_all(b"{\"region\": ").expect("sent");
    let start = Instant::now();
    let response = read_to_close(slow);
    assert!(start.elapsed() < PATIENCE / 2);
    assert!(response.starts_with("HTTP/1.1 408"), "{response}");
    for words in [
        "application/problem+json",
        "urn:strew:problem:body-too-slow",
        "0.3",
    ] {
        assert!(response.contains(words), "no `{words}`: {response}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_message_that_does_not_arrive_times_out() {
    let daemon = Daemon::start(&["server.body_read_timeout_seconds=0.3"]);
    let stream = tokio::net::TcpStream::connect(daemon.address()).await;
    let (mut client, connection) = h2::client::handshake(stream.expect("connected"))
        .await
        .expect("HTTP/2");
    tokio::spawn(connection);
    let call = http::Request::post(daemon.url("/strew.v1.PointService/StreamPoints"))
        .header("content-type", "application/grpc")
        .header("te", "trailers")
        .body(())
        .expect("valid");
    let (answer, mut body) = client.send_request(call, false).expect("sent");
    body.send_data(bytes::Bytes::from_static(&[0, 0, 0, 1, 0]), false)
        .expect("sent");
    let answer = tokio::time::timeout(PATIENCE, answer).await;
    let answer = answer.expect("in time").expect("an answer");
    let status = answer.headers().get("grpc-status").expect("at once");
    assert_eq!(status, "4", "{answer:?}");
}

#[test]
fn a_plan_that_takes_too_long_is_refused_and_stops() {
    let daemon = patient(&["server.first_byte_seconds=0.5"]);
    for path in ["/v1/count", "/v1/points:query", "/v1/points:split?parts=3"] {
        let answer = http1::post(daemon.address(), path, &[], SLOW.as_bytes());
        assert_eq!(answer.status, 503, "{}", answer.text());
        assert_eq!(answer.header("retry-after"), "5");
        assert_eq!(answer.json()["type"], "urn:strew:problem:time-over");
        until("the daemon stops computing", || !is_busy(&daemon));
    }
    assert_eq!(daemon.streams(), 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_call_that_takes_too_long_is_refused_and_stops() {
    let daemon = patient(&["server.first_byte_seconds=0.5"]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let request = StreamPointsRequest {
        region: boxed([0.0, 0.0, 1e10, 1e10]),
        set: Some(PointSet {
            amount: Some(Amount::Spacing(1.0)),
            profile: Some(PROFILE.into()),
            seed: Some(7),
            ..PointSet::default()
        }),
        ..StreamPointsRequest::default()
    };
    let status = client.count_points(request).await;
    let status = status.expect_err("it takes too long");
    assert_eq!(status.code(), Code::ResourceExhausted, "{status:?}");
    let details = status.get_error_details();
    assert_eq!(details.error_info().expect("details").reason, "TIME_OVER");
    let delay = details.retry_info().expect("details").retry_delay;
    assert_eq!(delay, Some(Duration::from_secs(5)));
    until("the daemon stops computing", || !is_busy(&daemon));
}

#[test]
fn a_plan_stops_when_its_client_leaves() {
    let daemon = patient(&["server.first_byte_seconds=3600"]);
    let body = Some(SLOW.as_bytes());
    let client = http1::send(daemon.address(), "POST", "/v1/count", &[], body).expect("sent");
    until("the daemon computes", || is_busy(&daemon));
    drop(client);
    until("the daemon stops computing", || !is_busy(&daemon));
}

#[test]
fn an_answer_that_takes_too_long_is_incomplete() {
    let daemon = Daemon::start(&["server.max_stream_seconds=0.5"]);
    for format in ["f32", "json", "ndjson"] {
        let opened = http1::open(daemon.address(), "GET", &long(format), &[]);
        assert_eq!(opened.status, 200);
        assert!(!opened.drain(), "{format} looks complete");
    }
    daemon.until_no_streams();
}

#[tokio::test(flavor = "multi_thread")]
async fn a_grpc_stream_that_takes_too_long_gets_a_status() {
    let daemon = Daemon::start(&["server.max_stream_seconds=0.5"]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let mut stream = client
        .stream_points(square(LONG))
        .await
        .expect("an answer")
        .into_inner();
    let status = broken_off(&mut stream).await;
    assert_eq!(status.code(), Code::ResourceExhausted, "{status:?}");
    assert!(status.message().contains("incomplete"), "{status:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_stalled_stream_ends_although_its_connection_lives() {
    let daemon = Daemon::start(&["server.stalled_reader_seconds=0.5"]);
    let stream = tokio::net::TcpStream::connect(daemon.address()).await;
    // The window of the connection is larger than that of one stream.
    let (client, connection) = h2::client::Builder::new()
        .initial_connection_window_size(1 << 20)
        .handshake::<_, bytes::Bytes>(stream.expect("connected"))
        .await
        .expect("HTTP/2");
    tokio::spawn(connection);
    let ask = |path: &str| {
        let mut client = client.clone();
        let request = http::Request::get(daemon.url(path))
            .body(())
            .expect("valid");
        async move {
            let (answer, _) = client.send_request(request, true).expect("sent");
            answer.await.expect("an answer")
        }
    };
    let mut untouched = ask(&long("f32")).await.into_body();
    let start = Instant::now();
    while daemon.streams() > 0 {
        assert!(start.elapsed() < PATIENCE, "the stream is still there");
        let mut alive = ask("/livez").await.into_body();
        while let Some(data) = alive.data().await {
            let data = data.expect("whole");
            alive
                .flow_control()
                .release_capacity(data.len())
                .expect("held");
        }
    }
    // The data sent before arrives first, then the reset.
    let broken = loop {
        match untouched.data().await {
            Some(Ok(data)) => {
                let window = untouched.flow_control();
                window.release_capacity(data.len()).expect("held");
            }
            Some(Err(error)) => break error,
            None => panic!("the stream looks complete"),
        }
    };
    assert!(broken.is_reset(), "{broken}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_reader_that_is_too_slow_is_broken_off_although_its_socket_never_is_full() {
    let daemon = Daemon::start(&[
        "server.stalled_reader_seconds=1",
        "server.min_bytes_per_second=1e9",
    ]);
    let stream = tokio::net::TcpStream::connect(daemon.address()).await;
    let (mut client, connection) = h2::client::Builder::new()
        .initial_window_size(1000)
        .handshake::<_, bytes::Bytes>(stream.expect("connected"))
        .await
        .expect("HTTP/2");
    tokio::spawn(connection);
    let request = http::Request::get(daemon.url(&long("f32"))).body(());
    let (answer, _) = client
        .send_request(request.expect("valid"), true)
        .expect("sent");
    let mut body = answer.await.expect("an answer").into_body();
    let broken = async {
        loop {
            let data = match body.data().await.expect("more") {
                Ok(data) => data,
                Err(error) => return error,
            };
            let _ = body.flow_control().release_capacity(data.len());
        }
    };
    let broken = tokio::time::timeout(PATIENCE, broken).await;
    assert!(broken.expect("in time").is_reset());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_connection_without_a_window_is_closed() {
    let daemon = Daemon::start(&["server.stalled_reader_seconds=0.5"]);
    let stream = tokio::net::TcpStream::connect(daemon.address()).await;
    // Without a window, even the smallest answer cannot be sent.
    let (mut client, connection) = h2::client::Builder::new()
        .initial_window_size(0)
        .handshake::<_, bytes::Bytes>(stream.expect("connected"))
        .await
        .expect("HTTP/2");
    let ended = tokio::spawn(connection);
    let request = http::Request::get(daemon.url("/openapi.json"))
        .body(())
        .expect("valid");
    let (answer, _) = client.send_request(request, true).expect("sent");
    let _untouched = answer.await.expect("an answer");
    let ended = tokio::time::timeout(PATIENCE, ended).await;
    // With or without an error.
    let _ = ended.expect("it ends").expect("no panic");
}

#[test]
fn nothing_is_timed_by_a_clock_that_can_jump() {
    fn look(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                look(&path, found);
            } else if fs::read_to_string(&path).is_ok_and(|text| text.contains("SystemTime")) {
                found.push(path);
            }
        }
    }
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = vec![];
    look(&source, &mut found);
    // Deadlines, intervals and ages are measured with `Instant`, which never jumps. The time of day
    // is for metrics, spans, and the times of files.
    found.retain(|path| {
        let known = [
            "ops/metrics/mod.rs",
            "ops/reload/fingerprint.rs",
            "ops/spans/exporter.rs",
            "ops/tls.rs",
        ];
        !known.iter().any(|known| path.ends_with(known))
    });
    assert!(found.is_empty(), "{found:?}");
}
