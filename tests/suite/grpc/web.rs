//! gRPC-Web on the same port, as scripts of a page use it: POST over HTTP/1.1, with the status in
//! the last frame of the body.

use base64::{Engine as _, engine::general_purpose::STANDARD};
use prost::Message as _;
use strew::grpc::proto::{
    Layer, PointSet, StreamPointsRequest, StreamPointsResponse, point_set::Amount,
    stream_points_response::Message,
};
use strew_testkit::{http1, wait::until};

use crate::support::{
    daemon::Daemon,
    grpc::{boxed, set},
    metrics::{samples, sum},
};

const STREAM: &str = "/strew.v1.PointService/StreamPoints";

/// A frame: one byte of flags, the length, the content.
fn frame(content: &[u8]) -> Vec<u8> {
    let mut frame = vec![0];
    let length = u32::try_from(content.len()).expect("short");
    frame.extend(length.to_be_bytes());
    frame.extend(content);
    frame
}

/// The frames of a body, as (flags, content).
fn frames(mut body: &[u8]) -> Vec<(u8, &[u8])> {
    let mut frames = vec![];
    while let [flags, a, b, c, d, rest @ ..] = body {
        let length = u32::from_be_bytes([*a, *b, *c, *d]) as usize;
        frames.push((*flags, &rest[..length]));
        body = &rest[length..];
    }
    assert!(body.is_empty());
    frames
}

fn request(density: f64) -> Vec<u8> {
    let request = StreamPointsRequest {
        region: boxed([0.0, 0.0, 20.0, 20.0]),
        set: set(Amount::Density(density)),
        ..StreamPointsRequest::default()
    };
    frame(&request.encode_to_vec())
}

const WEB: (&str, &str) = ("content-type", "application/grpc-web+proto");
const PAGE: (&str, &str) = ("origin", "https://page.example");

#[test]
fn a_page_gets_points_and_a_status() {
    let daemon = Daemon::start(&["limits.block_bytes=4096"]);
    let opened = http1::open_post(daemon.address(), STREAM, &[WEB, PAGE], &request(2.0));
    assert_eq!(opened.status, 200);
    assert_eq!(opened.headers["content-type"], WEB.1);
    assert_eq!(opened.headers["access-control-allow-origin"], "*");
    assert_eq!(opened.headers["access-control-expose-headers"], "*");
    let (body, complete) = opened.finish();
    assert!(complete);
    let mut frames = frames(&body);
    let (flags, trailers) = frames.pop().expect("trailers");
    assert_eq!(flags, 0x80);
    let trailers = String::from_utf8_lossy(trailers).to_lowercase();
    assert!(trailers.contains("grpc-status:0"), "{trailers}");
    let mut points = vec![];
    for (flags, content) in frames {
        assert_eq!(flags, 0);
        let response = StreamPointsResponse::decode(content).expect("a message");
        if let Some(Message::Block(block)) = response.message {
            points.extend(block.x.into_iter().zip(block.y));
        }
    }
    let path = "/v1/points?bbox=0,0,20,20&density=2&profile=test";
    let rest = daemon.get(path).json();
    let listed = rest["points"].as_array().expect("a list");
    assert_eq!(points.len(), listed.len());
    for ((x, y), point) in points.iter().zip(listed) {
        assert_eq!((&point["x"], &point["y"]), (&(*x).into(), &(*y).into()));
    }
}

#[test]
fn preflight_requests_are_allowed() {
    let daemon = Daemon::start(&[]);
    let asks = [
        PAGE,
        ("access-control-request-method", "POST"),
        (
            "access-control-request-headers",
            "content-type,x-grpc-web,grpc-timeout",
        ),
    ];
    let allowed = http1::request(daemon.address(), "OPTIONS", STREAM, &asks);
    assert_eq!(allowed.status, 204);
    assert!(
        allowed
            .header("access-control-allow-methods")
            .contains("POST")
    );
}

#[test]
fn errors_reach_a_page_too() {
    let daemon = Daemon::start(&[]);
    let opened = http1::open_post(daemon.address(), STREAM, &[WEB, PAGE], &request(-2.0));
    assert_eq!(
        (opened.status, opened.headers["grpc-status"].as_str()),
        (200, "3")
    );
    assert!(opened.headers["grpc-message"].contains("set.density"));
    assert!(opened.headers.contains_key("grpc-status-details-bin"));

    let nothing = "/strew.v1.PointService/Nothing";
    let opened = http1::open_post(daemon.address(), nothing, &[WEB, PAGE], &frame(&[]));
    let (headers, (body, _)) = (opened.headers.clone(), opened.finish());
    let in_head = headers.get("grpc-status").map(String::as_str) == Some("12");
    assert!(in_head || String::from_utf8_lossy(&body).contains("grpc-status:12"));
}

#[test]
fn answers_are_compressed_on_request() {
    let daemon = Daemon::start(&[]);
    let ask = |headers: &[(&str, &str)]| {
        let headers = [&[WEB], headers].concat();
        let opened = http1::open_post(daemon.address(), STREAM, &headers, &request(2.0));
        assert_eq!(opened.status, 200);
        opened.headers.get("grpc-encoding").cloned()
    };
    assert_eq!(ask(&[]), None);
    // Many libraries send this header whether or not their users want compression.
    let listed = ("grpc-accept-encoding", "identity, deflate, gzip");
    assert_eq!(ask(&[listed]), None);
    let gzip = ask(&[listed, ("grpc-encoding", "gzip")]);
    assert_eq!(gzip.as_deref(), Some("gzip"));
    let zstd = ask(&[("grpc-accept-encoding", "gzip,zstd")]);
    assert_eq!(zstd.as_deref(), Some("zstd"));
}

/// The bytes of a head.
fn head_bytes(opened: &http1::Response) -> usize {
    let lines = opened.headers.iter();
    lines
        .map(|(name, value)| name.len() + value.len() + 4)
        .sum()
}

#[test]
fn statuses_fit_the_heads_that_proxies_hold() {
    let daemon = Daemon::start(&[]);
    let layers = (0..1000).map(|i| Layer {
        name: format!("{}{i}", "\u{101}".repeat(60)),
        set: Some(PointSet {
            profile: Some("\u{101}".repeat(200)),
            amount: Some(Amount::Density(-1.0)),
            ..PointSet::default()
        }),
        ..Layer::default()
    });
    let request = StreamPointsRequest {
        region: boxed([0.0, 0.0, 20.0, 20.0]),
        layers: layers.collect(),
        ..StreamPointsRequest::default()
    };
    let request = frame(&request.encode_to_vec());
    let opened = http1::open_post(daemon.address(), STREAM, &[WEB, PAGE], &request);
    assert_eq!(opened.headers["grpc-status"], "3");
    let long = "x".repeat(5000);
    let timeout = [WEB, ("grpc-timeout", &*long)];
    let coding = [WEB, ("grpc-encoding", &*long)];
    let request = self::request(2.0);
    let others =
        [timeout, coding].map(|head| http1::open_post(daemon.address(), STREAM, &head, &request));
    for opened in [opened].into_iter().chain(others) {
        let bytes = head_bytes(&opened);
        assert!(bytes <= 4096, "{bytes}: {:?}", opened.headers);
    }
}

#[test]
fn calls_that_are_not_framed_are_the_clients_fault() {
    let daemon = Daemon::start(&[]);
    const CHECK: &str = "/grpc.health.v1.Health/Check";
    let text = "application/grpc-web-text";
    let binary = "application/grpc-web+proto";
    let length = [0, 0, 0, 0, 9];
    for path in [STREAM, CHECK] {
        for (content_type, body) in [
            (text, &b"AAA"[..]),
            (text, b"AAAAAAA"),
            (text, b"!!!!"),
            (text, b"AAAA\xff\xff\xff\xff"),
            (text, b"AAAAAAk="),
            (binary, b""),
            (binary, b"\0\0\0"),
            (binary, &length),
            (binary, b"\x02\0\0\0\0"),
            (binary, b"\x01\0\0\0\0"),
            (binary, b"\x01\0\0\0\x02\x1f\x8b"),
            (binary, b"\0\0\0\0\x02\xff\xff"),
        ] {
            let headers = [("content-type", content_type), PAGE];
            let opened = http1::open_post(daemon.address(), path, &headers, body);
            let code = opened.headers.get("grpc-status").cloned();
            let code = code.unwrap_or_else(|| {
                let (body, _) = opened.finish();
                panic!("{path} {content_type} {body:?}");
            });
            assert_eq!(code, "3", "{path} {content_type} {body:?}");
        }
    }
    let samples = samples(&daemon);
    let count = |status: &str| {
        sum(
            &samples,
            "strew_requests_total",
            &["protocol=\"grpc\"", status],
        )
    };
    assert_eq!(count("status=\"INVALID_ARGUMENT\""), 24.0);
    assert_eq!(count("status=\"INTERNAL\""), 0.0);
    assert_eq!(count("status=\"UNKNOWN\""), 0.0);
}

#[test]
fn streams_that_their_deadline_cuts_are_counted_so() {
    let daemon = Daemon::start(&["limits.max_points=4000000000"]);
    let text = STANDARD.encode(request(1e6));
    for (content_type, body) in [
        ("application/grpc-web+proto", request(1e6)),
        ("application/grpc-web-text", text.into_bytes()),
    ] {
        let headers = [
            ("content-type", content_type),
            PAGE,
            ("grpc-timeout", "200m"),
        ];
        let opened = http1::open_post(daemon.address(), STREAM, &headers, &body);
        assert_eq!(opened.status, 200);
        let _ = opened.finish();
    }
    // The report is made when the connection is over.
    let count =
        |name: &str, label: &str| sum(&samples(&daemon), name, &["protocol=\"grpc\"", label]);
    until("both are counted", || {
        count("strew_requests_total", "status=\"DEADLINE_EXCEEDED\"") == 2.0
    });
    assert_eq!(count("strew_requests_total", "status=\"2xx\""), 0.0);
    assert_eq!(count("strew_broken_total", "by=\"server\""), 0.0);
    assert_eq!(count("strew_broken_total", "by=\"client\""), 2.0);
}
