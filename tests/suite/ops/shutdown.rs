//! Stopping: first not ready, then no new connections, then an end of open streams.

use std::{
    net::TcpStream,
    time::{Duration, Instant},
};

use strew::grpc::proto::point_service_client::PointServiceClient;
use strew_testkit::{http1, wait::until};
use tonic::Code;

use crate::support::{
    daemon::Daemon,
    grpc::{LONG, broken_off, square},
    queries::long,
};

#[test]
fn an_idle_daemon_exits_at_once_with_success() {
    let mut daemon = Daemon::start(&[]);
    assert_eq!(daemon.get("/readyz").status, 200);
    daemon.terminate();
    let start = Instant::now();
    assert_eq!(daemon.wait().code(), Some(0));
    assert!(start.elapsed() < Duration::from_secs(3));
}

#[test]
fn readiness_ends_first_and_requests_are_still_answered() {
    let mut daemon = Daemon::start(&["shutdown.notice_seconds=2"]);
    daemon.terminate();
    until("the daemon is not ready", || {
        daemon.get("/readyz").status == 503
    });
    assert_eq!(daemon.get("/livez").status, 200);
    let points = daemon.get("/v1/points?bbox=0,0,5,5&density=1&profile=test");
    assert_eq!(points.status, 200);
    assert_eq!(daemon.wait().code(), Some(0));
}

#[test]
fn a_stream_that_ends_in_time_is_complete() {
    let mut daemon = Daemon::start(&["shutdown.drain_seconds=300"]);
    let path = "/v1/points?bbox=0,0,1500,1500&density=1&profile=test&format=ndjson";
    let mut reader = http1::open(daemon.address(), "GET", path, &[]);
    assert!(reader.skip(1).expect("a byte") > 0);
    daemon.terminate();
    until("no connection is accepted", || {
        TcpStream::connect(daemon.address()).err()
    });
    let (body, is_complete) = reader.finish();
    assert!(is_complete, "the stream broke off");
    let text = String::from_utf8(body).expect("UTF-8");
    assert!(text.ends_with("}\n") && text.contains("\"summary\""));
    assert_eq!(daemon.wait().code(), Some(0));
}

#[test]
fn a_stream_that_does_not_end_in_time_is_incomplete() {
    let mut daemon = Daemon::with_log(&["shutdown.drain_seconds=0.3"]);
    let open = |format: &str| http1::open(daemon.address(), "GET", &long(format), &[]);
    let readers = [open("ndjson"), open("f32"), open("json")];
    // A reader that never reads on must not delay the end.
    let _stuck = open("f64");
    let threads = readers.map(|reader| std::thread::spawn(move || reader.drain()));
    daemon.terminate();
    let start = Instant::now();
    assert_eq!(daemon.wait().code(), Some(0));
    assert!(start.elapsed() < Duration::from_secs(5));
    assert!((daemon.log_line("format=\"f64\"")).contains("broken=\"server\""));
    for thread in threads {
        let complete = thread.join().expect("no panic");
        assert!(!complete, "the answer looks complete");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_grpc_stream_that_does_not_end_in_time_gets_a_status() {
    let mut daemon = Daemon::start(&["shutdown.drain_seconds=0.3"]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let mut stream = client
        .stream_points(square(LONG))
        .await
        .expect("an answer")
        .into_inner();
    stream
        .message()
        .await
        .expect("a message")
        .expect("a header");
    daemon.terminate();
    let status = broken_off(&mut stream).await;
    assert_eq!(status.code(), Code::Unavailable, "{status:?}");
    assert!(status.message().contains("incomplete"), "{status:?}");
    let ended = tokio::task::spawn_blocking(move || daemon.wait());
    assert_eq!(ended.await.expect("no panic").code(), Some(0));
}
