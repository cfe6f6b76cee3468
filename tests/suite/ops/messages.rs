//! Messages and bodies that would take many times their bytes once they are read: they are refused for what
//! they have too much of, and take little until then.

use std::io::Write as _;

use base64::{Engine as _, prelude::BASE64_STANDARD};
use strew_testkit::http1;

use super::bad_calls::{call, frame};
use crate::support::{daemon::Daemon, problem::assert_fault};

const STREAM: &str = "/strew.v1.PointService/StreamPoints";
const QUERY: &str = "/v1/points:query";
/// The most memory for reading 4 MB, with all copies, in KiB.
const MOST_KIB: u64 = 64 << 10;

/// A field of bytes.
fn field(number: u32, bytes: &[u8]) -> Vec<u8> {
    let mut all = vec![];
    prost::encoding::encode_key(number, prost::encoding::WireType::LengthDelimited, &mut all);
    prost::encoding::encode_varint(bytes.len() as u64, &mut all);
    all.extend(bytes);
    all
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(vec![], flate2::Compression::default());
    encoder.write_all(bytes).expect("memory takes it");
    encoder.finish().expect("memory takes it")
}

/// Fails if the daemon's memory was ever this much above `before`.
fn stays_small(daemon: &Daemon, before: u64, name: &str) {
    let grown = daemon.memory_kib("VmHWM").saturating_sub(before);
    assert!(grown < MOST_KIB, "{name}: {grown} KiB");
}

/// A daemon that has answered once, and its memory.
fn warm() -> (Daemon, u64) {
    let daemon = Daemon::start(&[]);
    let answer = daemon.get("/v1/points?bbox=0,0,9,9&density=1&profile=test");
    assert_eq!(answer.status, 200);
    let before = daemon.memory_kib("VmRSS");
    (daemon, before)
}

/// Messages of nearly 4 MiB of nothing, with what they have too much of.
fn swollen() -> [(&'static str, Vec<u8>, &'static str); 5] {
    let many = |number: u32| field(number, b"").repeat(2_000_000);
    let part = field(2, &field(15, &field(10, &field(1, b"").repeat(10))));
    [
        ("layers", many(3), "2000000 layers"),
        (
            "parts",
            field(2, &field(15, &field(10, &many(1)))),
            "2000000 parts",
        ),
        ("regions", field(1, &field(5, &many(1))), "2000000 regions"),
        (
            "rings",
            field(1, &field(3, &field(1, &many(1)))),
            "2000000 rings",
        ),
        ("joined", part.repeat(100_000), "100000 values"),
    ]
}

#[tokio::test]
async fn messages_of_nothing_are_refused_before_they_are_decoded() {
    let (daemon, before) = warm();
    for (name, message, expected) in swollen() {
        let expected = expected.replace(' ', "%20");
        let packed = [
            ("identity", frame(0, &message)),
            ("gzip", frame(1, &gzip(&message))),
            (
                "zstd",
                frame(
                    1,
                    &zstd::encode_all(&message[..], 3).expect("memory takes it"),
                ),
            ),
        ];
        for (coding, body) in packed {
            let (status, text) = call(&daemon, STREAM, body, coding).await;
            assert_eq!(status, "3", "{name}, {coding}: {text}");
            assert!(text.contains(&expected), "{name}, {coding}: {text}");
            stays_small(&daemon, before, &format!("{name}, {coding}"));
        }
        let binary = frame(0, &message);
        let text = BASE64_STANDARD.encode(&binary).into_bytes();
        for (kind, body) in [("grpc-web+proto", binary), ("grpc-web-text+proto", text)] {
            let content = format!("application/{kind}");
            let headers = [("content-type", content.as_str())];
            let answer = http1::post(daemon.address(), STREAM, &headers, &body);
            assert_eq!(answer.header("grpc-status"), "3", "{name}, {kind}");
            stays_small(&daemon, before, &format!("{name}, {kind}"));
        }
    }
}

#[tokio::test]
async fn a_message_is_one_and_unpacks_to_no_more_than_a_body_may_have() {
    let (daemon, before) = warm();
    let zeros = frame(1, &gzip(&vec![0; 100 << 20]));
    let (status, text) = call(&daemon, STREAM, zeros, "gzip").await;
    assert_eq!(status, "8", "{text}");
    stays_small(&daemon, before, "zeros");
    for (name, body) in [
        ("two messages", frame(0, b"").repeat(2)),
        ("no message", vec![]),
        ("half a head", vec![0, 0]),
    ] {
        let (status, text) = call(&daemon, STREAM, body, "identity").await;
        assert_eq!(status, "3", "{name}: {text}");
    }
    let long = frame(0, &field(1, &[b'a'; 5000]));
    let (status, text) = call(&daemon, "/grpc.health.v1.Health/Check", long, "identity").await;
    assert_eq!(status, "8", "{text}");
}

/// A message that has no more than a query may have, and takes hundreds of times its bytes.
#[tokio::test]
async fn what_a_message_takes_once_it_is_decoded_counts_against_the_budget() {
    let parts = field(10, &field(1, b"").repeat(64));
    let entry = |kind: u8| field(20, &[field(1, &[b'A' + kind]), field(2, &parts)].concat());
    let set: Vec<u8> = (0..32).flat_map(entry).collect();
    let message = field(3, &field(4, &set)).repeat(16);
    assert!(message.len() < 80_000);
    let little = [
        "limits.max_bytes_in_flight=25000000",
        "limits.block_bytes=4096",
    ];
    for (settings, expected) in [(&little[..], "8"), (&[], "3")] {
        let daemon = Daemon::start(settings);
        let (status, text) = call(&daemon, STREAM, frame(0, &message), "identity").await;
        assert_eq!(status, expected, "{text}");
        assert_eq!(
            text.contains("limits.max_bytes_in_flight"),
            expected == "8",
            "{text}"
        );
    }
}

#[test]
fn lists_in_bodies_are_counted_while_they_are_read() {
    let (daemon, before) = warm();
    let list = |item: &str, count: usize| vec![item; count].join(",");
    let boxes = list(r#"{"bbox":[0,0,1,1]}"#, 210_000);
    let include = format!(r#"{{"spacing": 1, "region": {{"include": [{boxes}]}}}}"#);
    let rings = |inner: &str| {
        let coordinates = list(inner, 3_900_000 / (inner.len() + 1));
        format!(
            r#"{{"spacing": 1, "region": {{"polygon": {{"type": "MultiPolygon", "coordinates": [{coordinates}]}}}}}}"#
        )
    };
    let marks = |name: &str, item: &str| {
        let items = list(item, 3_900_000 / (item.len() + 1));
        format!(
            r#"{{"spacing": 1, "region": {{"bbox": [0, 0, 1, 1]}}, "field": {{"distance": {{"{name}": [{items}], "distances": [0, 1]}}}}}}"#
        )
    };
    for (name, body, at, texts) in [
        (
            "include",
            include,
            "region.include",
            vec!["210000 regions", "at most 1000"],
        ),
        (
            "polygons",
            rings("[]"),
            "region.polygon",
            vec!["contains no polygon, or empty ones alone"],
        ),
        (
            "rings",
            rings("[[]]"),
            "region.polygon",
            vec!["contains no polygon, or empty ones alone"],
        ),
        (
            "lines",
            marks("lines", "[]"),
            "field.distance.lines",
            vec!["1300000 shapes", "10000"],
        ),
        (
            "points",
            marks("points", "[0,0]"),
            "field.distance.points",
            vec!["650000 vertices"],
        ),
    ] {
        let answer = http1::post(daemon.address(), QUERY, &[], body.as_bytes());
        assert_fault(&answer, name, at, &texts);
        stays_small(&daemon, before, name);
        let packed = gzip(body.as_bytes());
        let coded = [("content-encoding", "gzip")];
        let answer = http1::post(daemon.address(), QUERY, &coded, &packed);
        assert_fault(&answer, name, at, &texts);
        stays_small(&daemon, before, &format!("{name}, packed"));
    }
}

#[test]
fn bodies_may_be_gzip_and_nothing_else() {
    let (daemon, before) = warm();
    let body = br#"{"region": {"bbox": [0, 0, 9, 9]}, "spacing": 1, "format": "csv"}"#;
    let send = |coding: &str, body: &[u8]| {
        let headers = [("content-encoding", coding)];
        http1::post(daemon.address(), QUERY, &headers, body)
    };
    let plain = http1::post(daemon.address(), QUERY, &[], body);
    assert_eq!(plain.status, 200, "{}", plain.text());
    for (coding, sent) in [
        ("gzip", gzip(body)),
        ("GZIP", gzip(body)),
        ("identity", body.to_vec()),
    ] {
        let answer = send(coding, &sent);
        assert_eq!(answer.status, 200, "{coding}: {}", answer.text());
        assert!(answer.body == plain.body, "{coding}");
    }
    for coding in ["br", "deflate", "zstd", "gzip, gzip", "gzip, br"] {
        let answer = send(coding, &gzip(body));
        assert_eq!(answer.status, 415, "{coding}: {}", answer.text());
        assert_eq!(answer.header("accept-encoding"), "gzip", "{coding}");
        let problem = answer.json();
        assert_eq!(problem["type"], "urn:strew:problem:unknown-coding");
        let detail = problem["detail"].as_str().expect("a text");
        assert!(detail.contains(coding), "{detail}");
    }
    for damaged in [&body[..], &gzip(body)[..20], b""] {
        assert_fault(&send("gzip", damaged), "damaged", "body", &["gzip"]);
    }
    assert_eq!(send("gzip", &gzip(&vec![b' '; 5 << 20])).status, 413);
    assert_eq!(send("gzip", &gzip(&vec![0; 100 << 20])).status, 413);
    stays_small(&daemon, before, "zeros");
}
