//! The parts of a call besides its query (a deadline, compression, a pinned table), and its ends: cancellation, and
//! requests that are not gRPC.

use std::time::{Duration, Instant};

use strew::grpc::proto::point_service_client::PointServiceClient;
use strew_testkit::http1;
use tonic::{Code, Request, codec::CompressionEncoding};
use tonic_types::StatusExt as _;

use crate::support::{
    daemon::{Daemon, PROFILE, table},
    grpc::{LONG, broken_off, square},
};

#[tokio::test(flavor = "multi_thread")]
async fn a_stream_stops_at_its_deadline() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let mut request = Request::new(square(LONG));
    let timeout = "2S".parse().expect("text");
    request.metadata_mut().insert("grpc-timeout", timeout);
    let start = Instant::now();
    let mut stream = client
        .stream_points(request)
        .await
        .expect("in time")
        .into_inner();
    let status = broken_off(&mut stream).await;
    assert_eq!(status.code(), Code::DeadlineExceeded, "{status:?}");
    assert!(status.message().contains("not complete"), "{status:?}");
    let info = status.get_details_error_info().expect("details");
    assert_eq!(info.reason, "DEADLINE_EXCEEDED");
    assert!(start.elapsed() >= Duration::from_secs(2));
    tokio::task::spawn_blocking(move || daemon.until_no_streams())
        .await
        .expect("no panic");
}

#[tokio::test]
async fn a_stream_that_ends_before_its_deadline_is_complete() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let mut request = Request::new(square(10.0));
    request.set_timeout(Duration::from_secs(3600));
    let mut stream = client
        .stream_points(request)
        .await
        .expect("in time")
        .into_inner();
    let mut messages = 0;
    while stream.message().await.expect("whole").is_some() {
        messages += 1;
    }
    assert_eq!(messages, 3);
}

#[tokio::test]
async fn an_unreadable_deadline_is_a_fault() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let mut request = Request::new(square(10.0));
    let soon = "soon".parse().expect("text");
    request.metadata_mut().insert("grpc-timeout", soon);
    let status = client.stream_points(request).await.expect_err("no timeout");
    assert_eq!(status.code(), Code::InvalidArgument, "{status:?}");
    let faults = status
        .get_details_bad_request()
        .expect("details")
        .field_violations;
    assert_eq!(faults[0].field, "grpc-timeout");
    assert!(faults[0].description.contains("soon"));
}

/// A client that stops reading and cancels frees its stream at once, although the daemon is
/// sending.
#[tokio::test(flavor = "multi_thread")]
async fn a_cancelled_call_frees_its_stream() {
    let daemon = Daemon::start(&["limits.max_streams=1"]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    for _ in 0..5 {
        let mut answer = client.stream_points(square(LONG)).await;
        // The stream before may still be finishing its last block.
        let start = Instant::now();
        while matches!(&answer, Err(status) if status.code() == Code::ResourceExhausted) {
            let status = answer.as_ref().expect_err("busy");
            assert_eq!(
                status
                    .get_details_retry_info()
                    .expect("details")
                    .retry_delay,
                Some(Duration::from_secs(1))
            );
            assert!(start.elapsed() < Duration::from_secs(5), "promptly");
            answer = client.stream_points(square(LONG)).await;
        }
        let mut stream = answer.expect("a place").into_inner();
        stream
            .message()
            .await
            .expect("a message")
            .expect("a header");
    }
    tokio::task::spawn_blocking(move || daemon.until_no_streams())
        .await
        .expect("no panic");
}

#[tokio::test]
async fn compressed_calls_get_the_same_points() {
    let daemon = Daemon::start(&[]);
    let channel = daemon.channel().await;
    let mut answers = vec![];
    let plain = || PointServiceClient::new(channel.clone());
    for mut client in [
        plain(),
        plain().accept_compressed(CompressionEncoding::Zstd),
        plain().accept_compressed(CompressionEncoding::Gzip),
        plain()
            .accept_compressed(CompressionEncoding::Gzip)
            .send_compressed(CompressionEncoding::Gzip),
        plain()
            .accept_compressed(CompressionEncoding::Zstd)
            .send_compressed(CompressionEncoding::Zstd),
    ] {
        let mut stream = client
            .stream_points(square(50.0))
            .await
            .expect("points")
            .into_inner();
        let mut messages = vec![];
        while let Some(message) = stream.message().await.expect("whole") {
            messages.push(message);
        }
        answers.push(messages);
    }
    assert!(answers[0].len() >= 3);
    for answer in &answers[1..] {
        assert!(*answer == answers[0]);
    }
}

#[tokio::test]
async fn another_table_than_the_pinned_one_is_a_failed_precondition() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let digest = table("(5-sqrt(3))/2", PROFILE).digest().to_string();
    let pinned = |table: &str| {
        let mut request = square(10.0);
        request.set.get_or_insert_default().table = Some(table.into());
        request
    };
    assert!(client.stream_points(pinned(&digest)).await.is_ok());
    let other = "0123456789abcdef".repeat(4);
    let status = client
        .stream_points(pinned(&other))
        .await
        .expect_err("other");
    assert_eq!(status.code(), Code::FailedPrecondition, "{status:?}");
    let details = status.get_error_details();
    let info = details.error_info().expect("details");
    assert_eq!(info.reason, "OTHER_TABLE");
    assert_eq!(
        (&info.metadata["pinned"], &info.metadata["loaded"]),
        (&other, &digest)
    );
    assert_eq!(
        details.precondition_failure().expect("details").violations[0].subject,
        other
    );
    let wrong = client
        .stream_points(pinned("abc"))
        .await
        .expect_err("wrong");
    assert_eq!(wrong.code(), Code::InvalidArgument);
}

#[test]
fn requests_that_are_not_calls_get_http_problems() {
    let daemon = Daemon::start(&[]);
    let path = "/strew.v1.PointService/StreamPoints";
    for (method, content_type, status) in [
        ("GET", "", 415),
        ("POST", "application/json", 415),
        ("POST", "application/grpc", 505),
        ("GET", "application/grpc-web", 405),
    ] {
        let headers = [("content-type", content_type)];
        let answer = http1::request(daemon.address(), method, path, &headers);
        assert_eq!(answer.status, status, "{method} {content_type}");
        assert_eq!(answer.header("content-type"), "application/problem+json");
        assert_eq!(answer.json()["status"], status);
    }
}
