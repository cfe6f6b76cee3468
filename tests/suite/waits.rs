//! How long the daemon waits for what: bodies, plans, readers, whole answers. And how much it takes
//! on meanwhile.

use std::{
    io::{Read as _, Write as _},
    net::TcpStream,
    time::{Duration, Instant},
};

use strew::grpc::proto::{
    CountPointsRequest, StreamPointsRequest, point_service_client::PointServiceClient,
    stream_points_request::Amount,
};
use tonic::Code;
use tonic_types::StatusExt as _;

use crate::{
    calls::boxed,
    daemon::{Daemon, PATIENCE, PROFILE, until},
    raw,
};

/// A query that takes minutes to count.
const SLOW: &str = r#"{"region": {"circle": {"center": [0, 0], "radius": 1e10}}, "spacing": 1, "profile": "test"}"#;

const LONG: &str = "/v1/points?bbox=0,0,3e4,3e4&density=1&profile=test&format=f32";

/// A daemon that would count for minutes.
fn patient(settings: &[&str]) -> Daemon {
    Daemon::start(&[&["limits.max_rows=1000000000000"], settings].concat())
}

/// Sends a request and waits for nothing.
fn send(daemon: &Daemon, path: &str, length: usize, body: &[u8]) -> TcpStream {
    let mut stream = TcpStream::connect(daemon.address()).expect("connected");
    stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
    let head = format!(
        "POST {path} HTTP/1.1\r\nhost: x\r\nconnection: close\r\ncontent-length: {length}\r\n\r\n"
    );
    stream.write_all(head.as_bytes()).expect("sent");
    stream.write_all(body).expect("sent");
    stream
}

fn heard(mut stream: TcpStream) -> String {
    let mut said = vec![];
    let _ = stream.read_to_end(&mut said);
    String::from_utf8_lossy(&said).into_owned()
}

/// Whether the daemon computes: its processor time grows while nobody asks anything.
fn is_busy(daemon: &Daemon) -> bool {
    let before = daemon.cpu_ticks();
    let start = Instant::now();
    while start.elapsed() < Duration::from_millis(500) {
        std::thread::park_timeout(Duration::from_millis(50));
    }
    // On a machine that is busy otherwise it does not get much.
    daemon.cpu_ticks() - before > 1
}

#[test]
fn a_body_that_does_not_come_is_not_waited_for() {
    let daemon = Daemon::start(&["server.body_read_timeout_seconds=0.3"]);
    let slow = send(&daemon, "/v1/points:query", 100, b"{\"region\": ");
    let start = Instant::now();
    let said = heard(slow);
    assert!(start.elapsed() < PATIENCE / 2);
    assert!(said.starts_with("HTTP/1.1 408"), "{said}");
    for words in [
        "application/problem+json",
        "urn:strew:problem:body-too-slow",
        "0.3",
    ] {
        assert!(said.contains(words), "no `{words}`: {said}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_call_that_does_not_come_is_not_waited_for() {
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
        let answer = raw::posted(daemon.address(), path, &[], SLOW.as_bytes());
        assert_eq!(answer.status, 503, "{}", answer.text());
        assert_eq!(answer.header("retry-after"), "5");
        assert_eq!(answer.json()["type"], "urn:strew:problem:time-over");
        until("nothing is computed", || (!is_busy(&daemon)).then_some(()));
    }
    assert_eq!(daemon.streams(), 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_call_that_takes_too_long_is_refused_and_stops() {
    let daemon = patient(&["server.first_byte_seconds=0.5"]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let request = StreamPointsRequest {
        region: boxed([0.0, 0.0, 1e10, 1e10]),
        amount: Some(Amount::Spacing(1.0)),
        profile: Some(PROFILE.into()),
        seed: Some(7),
        ..StreamPointsRequest::default()
    };
    let query = Some(request);
    let status = client.count_points(CountPointsRequest { query }).await;
    let status = status.expect_err("it takes too long");
    assert_eq!(status.code(), Code::ResourceExhausted, "{status:?}");
    let details = status.get_error_details();
    assert_eq!(details.error_info().expect("details").reason, "TIME_OVER");
    let delay = details.retry_info().expect("details").retry_delay;
    assert_eq!(delay, Some(Duration::from_secs(5)));
    until("nothing is computed", || (!is_busy(&daemon)).then_some(()));
}

#[test]
fn a_plan_stops_when_its_client_leaves() {
    let daemon = patient(&["server.first_byte_seconds=3600"]);
    let client = send(&daemon, "/v1/count", SLOW.len(), SLOW.as_bytes());
    until("it computes", || is_busy(&daemon).then_some(()));
    drop(client);
    until("nothing is computed", || (!is_busy(&daemon)).then_some(()));
}

#[test]
fn more_requests_than_allowed_are_asked_to_wait_and_probes_are_not() {
    let daemon = patient(&["server.first_byte_seconds=3600", "limits.max_requests=2"]);
    let mut slow = vec![];
    let small = "/v1/points?bbox=0,0,5,5&density=1&profile=test";
    let refused = until("two are under way", || {
        // The small one may have had the place that this one needed.
        slow.push(send(&daemon, "/v1/count", SLOW.len(), SLOW.as_bytes()));
        let answer = daemon.get(small);
        (answer.status != 200).then_some(answer)
    });
    assert_eq!(refused.status, 503);
    assert_eq!(refused.header("retry-after"), "1");
    assert_eq!(refused.json()["limit"], 2);
    assert_eq!(daemon.get("/livez").status, 200);
    assert_eq!(daemon.get("/readyz").status, 200);
    drop(slow);
    until("a place is free", || {
        (daemon.get(small).status == 200).then_some(())
    });
}

#[test]
fn what_bodies_and_streams_hold_is_bounded() {
    // Room for what one request may need: 28 MB, of which a stream takes 3.
    let daemon = Daemon::start(&["limits.max_bytes_in_flight=28000000"]);
    let length = 4_000_000;
    let body = vec![b' '; length - 1];
    let waiting: Vec<TcpStream> = (0..5)
        .map(|_| send(&daemon, "/v1/points:query", length, &body))
        .collect();
    let open = || raw::open(daemon.address(), "GET", LONG, &[]);
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
    let (body, _) = refused.finish();
    let problem: serde_json::Value = serde_json::from_slice(&body).expect("JSON");
    assert_eq!(problem["limit"], 28_000_000);
    // A sixth body has no room either.
    let said = heard(send(
        &daemon,
        "/v1/points:query",
        length,
        &vec![b' '; length],
    ));
    assert!(
        said.starts_with("HTTP/1.1 503") || said.is_empty(),
        "{said}"
    );
    for stream in &mut streams {
        assert!(stream.read(1 << 16).expect("it goes on") > 0);
    }
    drop((waiting, streams));
    until("there is room for many", || {
        let all: Vec<_> = (0..6).map(|_| open()).collect();
        all.iter().all(|opened| opened.status == 200).then_some(())
    });
}

#[test]
fn an_answer_whose_time_is_over_breaks_visibly() {
    let daemon = Daemon::start(&["server.max_stream_seconds=0.5"]);
    for format in ["f32", "json", "ndjson"] {
        let path = LONG.replace("f32", format);
        let opened = raw::open(daemon.address(), "GET", &path, &[]);
        assert_eq!(opened.status, 200);
        assert!(!opened.drain(), "{format} looks complete");
    }
    until("no stream is left", || {
        (daemon.streams() == 0).then_some(())
    });
}

fn long_stream() -> StreamPointsRequest {
    StreamPointsRequest {
        region: boxed([0.0, 0.0, 31_700.0, 31_700.0]),
        amount: Some(Amount::Density(1.0)),
        profile: Some(PROFILE.into()),
        ..StreamPointsRequest::default()
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_call_whose_time_is_over_ends_with_a_status() {
    let daemon = Daemon::start(&["server.max_stream_seconds=0.5"]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let mut stream = client
        .stream_points(long_stream())
        .await
        .expect("an answer")
        .into_inner();
    let status = loop {
        match stream.message().await {
            Ok(Some(_)) => {}
            Ok(None) => panic!("the stream looks complete"),
            Err(status) => break status,
        }
    };
    assert_eq!(status.code(), Code::ResourceExhausted, "{status:?}");
    assert!(status.message().contains("not complete"), "{status:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_stream_that_nobody_takes_ends_although_its_connection_lives() {
    let daemon = Daemon::start(&["server.stalled_reader_seconds=0.5"]);
    let stream = tokio::net::TcpStream::connect(daemon.address()).await;
    // One stream cannot fill what the connection may hold.
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
    let mut untouched = ask(LONG).await.into_body();
    let start = Instant::now();
    while daemon.streams() > 0 {
        assert!(start.elapsed() < PATIENCE, "it is there still");
        let mut alive = ask("/livez").await.into_body();
        while let Some(data) = alive.data().await {
            let data = data.expect("whole");
            alive
                .flow_control()
                .release_capacity(data.len())
                .expect("held");
        }
    }
    // What had been sent is there, and then it is broken.
    let broken = loop {
        match untouched.data().await {
            Some(Ok(data)) => {
                let window = untouched.flow_control();
                window.release_capacity(data.len()).expect("held");
            }
            Some(Err(error)) => break error,
            None => panic!("it looks complete"),
        }
    };
    assert!(broken.is_reset(), "{broken}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_connection_of_which_nothing_is_taken_ends() {
    let daemon = Daemon::start(&["server.stalled_reader_seconds=0.5"]);
    let stream = tokio::net::TcpStream::connect(daemon.address()).await;
    // No window: even the smallest answer waits.
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
    // With an error or without: it is over.
    let _ = ended.expect("it ends").expect("no panic");
}
