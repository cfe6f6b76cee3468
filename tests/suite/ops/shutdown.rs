//! Stopping: not ready first, then no new connections, then an end to what is still open.

use std::{
    net::TcpStream,
    time::{Duration, Instant},
};

use strew::grpc::proto::point_service_client::PointServiceClient;
use tonic::Code;

use strew_testkit::{http1, wait::until};

use crate::support::{
    daemon::Daemon,
    grpc::{LONG, square},
    queries::long,
};

#[test]
fn an_idle_daemon_ends_at_once_and_well() {
    let mut daemon = Daemon::start(&[]);
    assert_eq!(daemon.get("/readyz").status, 200);
    daemon.terminate();
    let start = Instant::now();
    assert_eq!(daemon.wait().code(), Some(0));
    assert!(start.elapsed() < Duration::from_secs(3));
}

#[test]
fn not_ready_comes_first_and_requests_are_still_answered() {
    let mut daemon = Daemon::start(&["shutdown.notice_seconds=2"]);
    daemon.terminate();
    until("readyz says no", || {
        (daemon.get("/readyz").status == 503).then_some(())
    });
    assert_eq!(daemon.get("/livez").status, 200);
    let points = daemon.get("/v1/points?bbox=0,0,5,5&density=1&profile=test");
    assert_eq!(points.status, 200);
    assert_eq!(daemon.wait().code(), Some(0));
}

#[test]
fn a_stream_that_ends_in_time_is_whole() {
    let mut daemon = Daemon::start(&["shutdown.drain_seconds=300"]);
    let path = "/v1/points?bbox=0,0,1500,1500&density=1&profile=test&format=ndjson";
    let mut reader = http1::open(daemon.address(), "GET", path, &[]);
    assert!(reader.skip(1).expect("a byte") > 0);
    daemon.terminate();
    until("no connection is taken", || {
        TcpStream::connect(daemon.address()).err()
    });
    let (body, is_complete) = reader.finish();
    assert!(is_complete, "the last chunk is there");
    let text = String::from_utf8(body).expect("UTF-8");
    assert!(text.ends_with("}\n") && text.contains("\"summary\""));
    assert_eq!(daemon.wait().code(), Some(0));
}

#[test]
fn a_stream_that_does_not_end_in_time_breaks_visibly() {
    let mut daemon = Daemon::start(&["shutdown.drain_seconds=0.3"]);
    let open = |format: &str| http1::open(daemon.address(), "GET", &long(format), &[]);
    let readers = [open("ndjson"), open("f32"), open("json")];
    // One that never reads on must not hold up the end either.
    let _stuck = open("f64");
    let threads = readers.map(|reader| std::thread::spawn(move || reader.drain()));
    daemon.terminate();
    let start = Instant::now();
    assert_eq!(daemon.wait().code(), Some(0));
    assert!(start.elapsed() < Duration::from_secs(5), "bounded");
    for thread in threads {
        let complete = thread.join().expect("no panic");
        assert!(!complete, "the reader sees that it is not complete");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_grpc_stream_breaks_with_a_status() {
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
    let status = loop {
        match stream.message().await {
            Ok(Some(_)) => {}
            Ok(None) => panic!("the stream looks complete"),
            Err(status) => break status,
        }
    };
    assert_eq!(status.code(), Code::Unavailable, "{status:?}");
    assert!(status.message().contains("not complete"), "{status:?}");
    let ended = tokio::task::spawn_blocking(move || daemon.wait());
    assert_eq!(ended.await.expect("no panic").code(), Some(0));
}
