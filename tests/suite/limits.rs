//! Limits refuse before the first byte, and say what they are.

use std::{
    io::{Read as _, Write as _},
    net::TcpStream,
};

use strew::grpc::proto::{
    StreamPointsRequest, point_service_client::PointServiceClient, stream_points_request::Amount,
};
use strew_core::{PointSet, Region};
use tonic::Code;
use tonic_types::StatusExt as _;

use crate::{
    calls::boxed,
    daemon::{Daemon, PATIENCE, PROFILE, table, until},
    raw,
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
    // The last holds more points than 64 bits can count.
    for half in [20.0, 1e5, 1e14] {
        let (count, path) = (
            count(half).to_string(),
            format!("/v1/points?bbox=-{half},-{half},{half},{half}&density=1&profile=test"),
        );
        let answer = daemon.get(&path);
        assert_eq!(answer.status, 413, "{}", answer.text());
        assert_eq!(answer.header("content-type"), "application/problem+json");
        assert!(
            answer.text().contains(&format!("\"count\":{count},")),
            "{}",
            answer.text()
        );
        assert!(answer.text().contains("\"limit\":1000"));

        let request = StreamPointsRequest {
            region: boxed([-half, -half, half, half]),
            amount: Some(Amount::Spacing(1.0)),
            profile: Some(PROFILE.into()),
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
fn more_streams_than_allowed_are_asked_to_wait() {
    let daemon = Daemon::start(&["limits.max_streams=2"]);
    let path = "/v1/points?bbox=0,0,3e4,3e4&density=1&profile=test&format=f32";
    let open = || raw::open(daemon.address(), "GET", path, &[]);
    let (first, second) = (open(), open());
    assert_eq!((first.status, second.status), (200, 200));
    let third = raw::get(daemon.address(), path, &[]);
    assert_eq!(third.status, 503, "{}", third.text());
    assert_eq!(third.header("retry-after"), "1");
    assert_eq!(third.json()["limit"], 2);
    drop(first);
    until("a place is free", || (open().status == 200).then_some(()));
}

#[test]
fn heads_are_bounded_in_size_and_time() {
    let daemon = Daemon::start(&[
        "server.max_header_bytes=8192",
        "server.header_read_timeout_seconds=0.2",
    ]);
    let long = format!("/v1/points?bbox={}", "1".repeat(9000));
    let answer = raw::open(daemon.address(), "GET", &long, &[]);
    assert!((414..=431).contains(&answer.status), "{}", answer.status);

    let mut slow = TcpStream::connect(daemon.address()).expect("connected");
    slow.set_read_timeout(Some(PATIENCE)).expect("a socket");
    slow.write_all(b"GET /livez HTTP/1.1\r\nhost")
        .expect("sent");
    let mut rest = vec![];
    // Closed by the daemon, with or without a word.
    let _ = slow.read_to_end(&mut rest);
    assert!(!rest.starts_with(b"HTTP/1.1 200"));
}
