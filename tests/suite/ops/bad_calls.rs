//! gRPC calls that break the contract: each ends with the status of its fault.

use bytes::Bytes;
use strew_testkit::wait::PATIENCE;

use crate::support::{attack::without_window, daemon::Daemon};

const COUNT: &str = "/strew.v1.PointService/CountPoints";

/// A gRPC frame.
pub(super) fn frame(flag: u8, message: &[u8]) -> Vec<u8> {
    let length = u32::try_from(message.len()).expect("short");
    [&[flag][..], &length.to_be_bytes(), message].concat()
}

/// Sends a call with a body and a header. Returns the status and its message, which a call without
/// an answer has in its head.
pub(super) async fn call(
    daemon: &Daemon,
    path: &str,
    body: Vec<u8>,
    coding: &str,
) -> (String, String) {
    let (client, _) = without_window(daemon.address()).await.expect("connected");
    let mut client = client.ready().await.expect("ready");
    let request = http::Request::post(daemon.url(path))
        .header("content-type", "application/grpc")
        .header("grpc-encoding", coding)
        .body(())
        .expect("valid");
    let (answer, mut sent) = client.send_request(request, false).expect("sent");
    // The daemon may refuse before it has read all.
    let _ = sent.send_data(Bytes::from(body), true);
    let answer = tokio::time::timeout(PATIENCE, answer).await;
    let answer = answer.expect("in time").expect("a head");
    let header = |name: &str| {
        let value = answer.headers().get(name);
        let value = value.map(|value| value.to_str().expect("text"));
        value.unwrap_or_default().to_owned()
    };
    (header("grpc-status"), header("grpc-message"))
}

#[tokio::test]
async fn a_message_above_the_limit_is_resource_exhausted() {
    let daemon = Daemon::start(&["limits.max_body_bytes=2000"]);
    let (status, message) = call(&daemon, COUNT, frame(0, &[0; 3000]), "identity").await;
    assert_eq!(status, "8", "{message}");
}

#[tokio::test]
async fn bytes_that_are_no_message_are_invalid_arguments() {
    let daemon = Daemon::start(&[]);
    let not_protobuf = frame(0, &[0xff; 30]);
    let not_a_flag = frame(7, b"");
    let not_gzip = frame(1, b"not compressed");
    let cut = frame(0, &[0; 30])[..20].to_vec();
    for (name, body, coding) in [
        ("not Protobuf", not_protobuf, "identity"),
        ("an unknown flag", not_a_flag, "identity"),
        ("not gzip", not_gzip, "gzip"),
        ("half a message", cut, "identity"),
    ] {
        let (status, message) = call(&daemon, COUNT, body, coding).await;
        assert_eq!(status, "3", "{name}: {message}");
    }
}

#[tokio::test]
async fn an_unknown_method_is_answered_with_those_that_are_there() {
    let daemon = Daemon::start(&[]);
    for path in ["/strew.v1.PointService/Nothing", "/nothing.at.all/Nothing"] {
        let (status, message) = call(&daemon, path, frame(0, b""), "identity").await;
        assert_eq!(status, "12", "{path}: {message}");
        assert!(message.contains("CountPoints"), "{path}: {message:?}");
    }
}
