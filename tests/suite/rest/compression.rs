//! Compressed answers: text only, the same bytes once decompressed, flushed block by block.

use std::io::Read;

use strew_testkit::http1;

use crate::support::{daemon::Daemon, queries::long};

const POINTS: &str = "/v1/points?bbox=0,0,60,60&density=1&profile=test&format=";

fn with(daemon: &Daemon, path: &str, coding: &str) -> http1::Answer {
    http1::get(daemon.address(), path, &[("accept-encoding", coding)])
}

fn plain(coding: &str, bytes: &[u8]) -> Vec<u8> {
    let mut text = vec![];
    match coding {
        "gzip" => flate2::read::GzDecoder::new(bytes).read_to_end(&mut text),
        _ => zstd::stream::read::Decoder::new(bytes)
            .expect("a decoder")
            .read_to_end(&mut text),
    }
    .expect("well coded");
    text
}

#[test]
fn text_is_compressed_for_clients_that_accept_it() {
    let daemon = Daemon::start(&["limits.block_bytes=4096"]);
    let mut paths: Vec<String> = ["json", "ndjson", "csv"]
        .iter()
        .map(|format| format!("{POINTS}{format}"))
        .collect();
    paths.extend(["/v1/profiles", "/v1/profiles/test", "/openapi.json"].map(Into::into));
    paths.push("/v1/profiles/test/spectrum.svg".into());
    for path in paths {
        let uncoded = daemon.get(&path);
        assert_eq!(uncoded.header("content-encoding"), "");
        for coding in ["gzip", "zstd"] {
            let coded = with(&daemon, &path, coding);
            assert_eq!(coded.header("content-encoding"), coding, "{path}");
            // Documents are compressed as a whole, so their length is known.
            let length = coded.header("content-length");
            let is_points = path.starts_with(POINTS);
            let expected = if is_points {
                String::new()
            } else {
                coded.body.len().to_string()
            };
            assert_eq!(length, expected, "{path}");
            assert_eq!(coded.header("content-type"), uncoded.header("content-type"));
            assert!(coded.body.len() < uncoded.body.len() * 3 / 4, "{path}");
            assert!(
                plain(coding, &coded.body) == uncoded.body,
                "{path} {coding}"
            );
            let head = http1::open(
                daemon.address(),
                "HEAD",
                &path,
                &[("accept-encoding", coding)],
            );
            assert_eq!(head.headers["content-encoding"], coding);
            let announced = head.headers.get("content-length");
            assert!(
                announced.is_none_or(|announced| announced == length),
                "{path}"
            );
            assert_eq!(head.headers.get("etag"), coded.headers.get("etag"));
            assert_eq!(head.raw_rest(), b"");
        }
        let all = with(&daemon, &path, "gzip, deflate, br, zstd");
        assert_eq!(all.header("content-encoding"), "zstd");
        assert_eq!(with(&daemon, &path, "br").header("content-encoding"), "");
    }
}

#[test]
fn packed_numbers_and_short_problems_are_not_compressed() {
    let daemon = Daemon::start(&[]);
    for format in ["f32", "f64"] {
        let path = format!("{POINTS}{format}");
        let answer = with(&daemon, &path, "gzip, zstd");
        assert_eq!(answer.header("content-encoding"), "");
        assert_eq!(
            answer.header("content-length"),
            answer.body.len().to_string()
        );
        assert_eq!(answer.header("etag"), daemon.get(&path).header("etag"));
    }
    let problem = with(
        &daemon,
        "/v1/points?bbox=0,0,1,1&density=1&profile=test&seed=x",
        "gzip",
    );
    assert_eq!(
        (problem.status, problem.header("content-encoding")),
        (400, "")
    );
}

/// A compressed answer that takes long: its first bytes arrive at once, and it ends with its
/// reader.
#[test]
fn compressed_blocks_are_flushed_one_by_one() {
    let daemon = Daemon::start(&[]);
    let path = long("csv");
    for coding in ["gzip", "zstd"] {
        let headers = [("accept-encoding", coding)];
        let mut opened = http1::open(daemon.address(), "GET", &path, &headers);
        assert!(opened.skip(1 << 16).expect("bytes") > 0);
        assert_eq!(daemon.streams(), 1);
        drop(opened);
        daemon.until_no_streams();
    }
}

#[test]
fn a_compressed_stream_that_breaks_off_is_incomplete() {
    let mut daemon = Daemon::start(&["shutdown.drain_seconds=0.2"]);
    let opened = http1::open(
        daemon.address(),
        "GET",
        &long("csv"),
        &[("accept-encoding", "gzip")],
    );
    let reader = std::thread::spawn(move || opened.drain());
    daemon.terminate();
    assert_eq!(daemon.wait().code(), Some(0));
    assert!(
        !reader.join().expect("no panic"),
        "the answer looks complete"
    );
}
