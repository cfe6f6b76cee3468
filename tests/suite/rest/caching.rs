//! Entity tags, conditional requests, and how long answers may be cached.

use strew_testkit::{
    http1,
    tables::{random, write},
};

use crate::support::{
    daemon::{Daemon, table},
    queries::long,
};

const POINTS: &str = "/v1/points?bbox=0,0,10,10&density=1&profile=test";

/// Paths whose answers may be cached.
const CACHEABLE: [&str; 7] = [
    POINTS,
    "/v1/points?bbox=0,0,10,10&density=1&profile=test&format=csv",
    "/v1/points?bbox=0,0,10,10&density=1&profile=test&format=f32",
    "/v1/profiles",
    "/v1/profiles/test",
    "/v1/profiles/test/spectrum.svg",
    "/openapi.json",
];

fn with(daemon: &Daemon, path: &str, headers: &[(&str, &str)]) -> http1::Answer {
    http1::get(daemon.address(), path, headers)
}

#[test]
fn a_matching_tag_gets_304() {
    let daemon = Daemon::start(&[]);
    for path in CACHEABLE {
        let first = daemon.get(path);
        assert_eq!(first.status, 200, "{path}");
        let tag = first.header("etag");
        assert!(tag.starts_with('"') && tag.len() > 30, "{path}: {tag}");
        assert_eq!(first.header("cache-control"), "public, max-age=300");
        assert!(first.header("vary").contains("accept-encoding"), "{path}");
        for asked in [
            tag.to_owned(),
            format!("W/{tag}"),
            format!("\"other\", {tag}"),
            "*".into(),
        ] {
            let again = with(&daemon, path, &[("if-none-match", &asked)]);
            assert_eq!(again.status, 304, "{path} {asked}");
            assert!(again.body.is_empty());
            for name in ["etag", "cache-control", "vary"] {
                assert_eq!(again.header(name), first.header(name), "{path} {name}");
            }
        }
        let other = with(&daemon, path, &[("if-none-match", "\"other\"")]);
        assert_eq!(other.status, 200, "{path}");
        assert_eq!(other.body, first.body, "{path}: a strong tag");
    }
}

#[test]
fn a_304_needs_no_stream() {
    let daemon = Daemon::start(&["limits.max_streams=1"]);
    let tag = daemon.get(POINTS).header("etag").to_owned();
    let _open = http1::open(daemon.address(), "GET", &long("f32"), &[]);
    assert_eq!(daemon.get(POINTS).status, 503);
    let again = with(&daemon, POINTS, &[("if-none-match", &tag)]);
    assert_eq!(again.status, 304);
    let head = http1::request(daemon.address(), "HEAD", POINTS, &[]);
    assert_eq!((head.status, head.header("etag")), (200, tag.as_str()));
}

#[test]
fn a_refused_query_is_refused_whatever_tag_is_sent() {
    let daemon = Daemon::start(&["limits.max_points=50"]);
    let any = with(&daemon, POINTS, &[("if-none-match", "*")]);
    assert_eq!(any.status, 413);
    assert_eq!(any.header("cache-control"), "no-store");
    assert_eq!(any.header("etag"), "");
}

#[test]
fn different_answers_have_different_tags() {
    let daemon = Daemon::start(&[]);
    let tag = |path: &str, headers: &[(&str, &str)]| {
        with(&daemon, path, headers).header("etag").to_owned()
    };
    let mut tags = vec![
        tag(POINTS, &[]),
        tag(POINTS, &[("accept", "text/csv")]),
        tag(POINTS, &[("accept-encoding", "gzip")]),
        tag(POINTS, &[("accept-encoding", "zstd")]),
        tag(&format!("{POINTS}&seed=1"), &[]),
        tag(&format!("{POINTS}&alpha=sqrt(3)"), &[]),
    ];
    // Another table answers the same path with another tag.
    let tables = tempfile::tempdir().expect("a temporary folder");
    let other = random("(5-sqrt(3))/2", "test", 21);
    write(tables.path(), "a.strew", &other);
    let changed = Daemon::with_tables(tables, &[]);
    tags.push(changed.get(POINTS).header("etag").to_owned());
    let unique: std::collections::BTreeSet<_> = tags.iter().collect();
    assert_eq!(unique.len(), tags.len(), "{tags:?}");
    assert!(tags[2].ends_with("-gzip\"") && tags[3].ends_with("-zstd\""));
    // A restart changes no tag.
    assert_eq!(Daemon::start(&[]).get(POINTS).header("etag"), tags[0]);
}

#[test]
fn answers_of_a_pinned_table_are_immutable_or_refused() {
    let daemon = Daemon::start(&["http.cache_seconds=7"]);
    let digest = table("(5-sqrt(3))/2", "test").digest().to_string();
    for path in [
        format!("{POINTS}&table={digest}"),
        format!("{POINTS}&table={}", digest.to_uppercase()),
        format!("/v1/profiles/test?table={digest}"),
        format!("/v1/profiles/test/spectrum.svg?table={digest}"),
    ] {
        let answer = daemon.get(&path);
        assert_eq!(answer.status, 200, "{path}: {}", answer.text());
        let forever = "public, max-age=31536000, immutable";
        assert_eq!(answer.header("cache-control"), forever, "{path}");
    }
    let plain = daemon.get(POINTS);
    assert_eq!(plain.header("cache-control"), "public, max-age=7");

    let pin = "0123456789abcdef".repeat(4);
    for path in [POINTS, "/v1/profiles/test?alpha=(5-sqrt(3))/2"] {
        let other = daemon.get(&format!("{path}&table={pin}"));
        assert_eq!(other.status, 409, "{}", other.text());
        let problem = other.json();
        assert_eq!(problem["type"], "urn:strew:problem:other-table");
        assert_eq!(problem["pinned"], pin);
        assert_eq!(problem["loaded"], digest);
        assert_eq!(other.header("cache-control"), "no-store");

        let wrong = daemon.get(&format!("{path}&table=abc"));
        assert_eq!(wrong.status, 400);
        assert_eq!(wrong.json()["errors"][0]["field"], "table");
    }
}
