//! `Range`: a part of the bytes of an answer is that part of the whole.

use strew_testkit::http1;

use crate::support::daemon::Daemon;

const QUERY: &str = "/v1/points?bbox=-7,1,33,55&spacing=0.5&seed=7&format=";

fn get(daemon: &Daemon, path: &str, headers: &[(&str, &str)]) -> http1::Answer {
    http1::get(daemon.address(), path, headers)
}

#[test]
fn a_part_has_the_bytes_of_the_whole() {
    let daemon = Daemon::built_in();
    let more = "&attributes=angle,variant&variants=oak:1,pine:2&spread=even&offset=100&limit=3000";
    for path in [
        format!("{QUERY}f32"),
        format!("{QUERY}f64"),
        format!("{QUERY}f64{more}"),
        format!("{QUERY}npy{more}"),
        format!("{QUERY}ply"),
        format!("{QUERY}instances"),
        format!("{QUERY}multimesh&warp=off"),
        format!("{QUERY}parquet{more}"),
        "/v1/points?bbox=3,0,403,400&spacing=1&seed=7&attributes=variant&variants=a:1,b:2&format=parquet".into(),
        "/v1/space/points?bbox=0,0,0,9,9,9&spacing=1&format=parquet".into(),
        "/v1/points?bbox=0,0,1e-9,1e-9&spacing=1&format=parquet".into(),
        "/v1/points?bbox=0,0,27,27&spacing=1&format=csv".into(),
        "/v1/chunks/32/3/-2?spacing=0.5&seed=7&format=f32".into(),
    ] {
        let whole = daemon.get(&path);
        assert_eq!(whole.header("accept-ranges"), "bytes", "{path}");
        let size = whole.body.len();
        let head = http1::open(daemon.address(), "HEAD", &path, &[]);
        assert_eq!(head.header("content-length"), size.to_string(), "{path}");
        let ranges = [
            ("0-0", 0..1),
            ("0-", 0..size),
            ("3-100", 3..101),
            ("1000-1007", 1000..1008),
            ("777-9999", 777..size.min(10_000)),
            ("4-", 4..size),
            ("-5000", size.saturating_sub(5000)..size),
            ("-11", size - 11..size),
            (&format!("{}-999999999", size - 1), size - 1..size),
            (&format!("-{}", 2 * size), 0..size),
        ];
        for (range, expected) in ranges {
            let answer = get(&daemon, &path, &[("range", &format!("bytes={range}"))]);
            assert_eq!(answer.status, 206, "{path} {range}: {}", answer.text());
            let place = format!("bytes {}-{}/{size}", expected.start, expected.end - 1);
            assert_eq!(answer.header("content-range"), place);
            assert_eq!(answer.header("content-length"), expected.len().to_string());
            for name in ["etag", "strew-count", "strew-columns", "content-type"] {
                assert_eq!(answer.header(name), whole.header(name), "{path}: {name}");
            }
            assert!(answer.body == whole.body[expected], "{path} {range}");
        }
        let beyond = get(&daemon, &path, &[("range", &format!("bytes={size}-"))]);
        assert_eq!(beyond.status, 416);
        assert_eq!(beyond.header("content-range"), format!("bytes */{size}"));
    }
}

#[test]
fn what_is_no_single_range_of_the_present_answer_is_answered_in_full() {
    let daemon = Daemon::built_in();
    let path = format!("{QUERY}f32");
    let whole = daemon.get(&path);
    let tag = whole.header("etag");
    for headers in [
        &[("range", "bytes=0-1,4-5")][..],
        &[("range", "points=0-1")],
        &[("range", "bytes=5-1")],
        &[("range", "bytes=-")],
        &[("range", "bytes=x-1")],
        &[("range", "bytes=0-9"), ("if-range", "\"another\"")],
    ] {
        let answer = get(&daemon, &path, headers);
        assert_eq!((answer.status, answer.body.len()), (200, whole.body.len()));
    }
    let current = [("range", "bytes=0-9"), ("if-range", tag)];
    assert_eq!(get(&daemon, &path, &current).status, 206);
    let known = [("range", "bytes=0-9"), ("if-none-match", tag)];
    assert_eq!(get(&daemon, &path, &known).status, 304);
    // RFC 9110, 13.2.2: If-Match first, then If-None-Match, then If-Range.
    let weak = format!("W/{tag}");
    for (condition, status) in [
        (("if-match", tag), 206),
        (("if-match", "*"), 206),
        (("if-match", "\"stale\""), 412),
        (("if-match", &*weak), 412),
    ] {
        let ranged = [condition, ("range", "bytes=0-9"), ("if-range", tag)];
        let answer = get(&daemon, &path, &ranged);
        assert_eq!(answer.status, status, "{condition:?}");
        let whole = if status == 206 { 200 } else { status };
        assert_eq!(
            get(&daemon, &path, &[condition]).status,
            whole,
            "{condition:?}"
        );
        let head = http1::open(daemon.address(), "HEAD", &path, &[condition]);
        assert_eq!(head.status, whole, "{condition:?}");
        let known = [condition, ("if-none-match", tag)];
        let known = get(&daemon, &path, &known).status;
        assert_eq!(
            known,
            if status == 412 { 412 } else { 304 },
            "{condition:?}"
        );
    }
    let stale = [("if-match", "\"stale\"")];
    let failed = get(&daemon, &path, &stale);
    assert_eq!(failed.header("content-type"), "application/problem+json");
    for path in [
        "/v1/profiles",
        "/openapi.json",
        "/docs",
        "/v1/count?bbox=0,0,9,9&spacing=1",
    ] {
        assert_eq!(get(&daemon, path, &stale).status, 412, "{path}");
        assert_eq!(
            get(&daemon, path, &[("if-match", "*")]).status,
            200,
            "{path}"
        );
    }
    // A request that fails in any case is answered as without conditions (13.2.1).
    assert_eq!(
        get(&daemon, "/v1/points?bbox=0,0,1e9,1e9&spacing=1", &stale).status,
        413
    );
    // A query in a body has no answer that is kept.
    let body = r#"{"region":{"bbox":[0,0,3,2]},"spacing":1,"format":"csv"}"#;
    let posted = http1::post(
        daemon.address(),
        "/v1/points:query",
        &[("if-none-match", "*")],
        body.as_bytes(),
    );
    assert!(posted.status == 200 && posted.text().lines().count() > 1);
    let head = http1::open(daemon.address(), "HEAD", &path, &current);
    assert_eq!(head.status, 200);
    let csv = get(&daemon, &format!("{QUERY}csv"), &[("range", "bytes=0-9")]);
    assert_eq!((csv.status, csv.header("accept-ranges")), (200, ""));
    let empty = "/v1/points?bbox=0,0,1e-9,1e-9&spacing=1&format=f32";
    assert_eq!(get(&daemon, empty, &[("range", "bytes=0-")]).status, 416);
}

#[test]
fn only_the_points_of_a_part_are_made() {
    let daemon = Daemon::start(&[]);
    let path = "/v1/points?bbox=0,0,3000,3000&spacing=1&profile=test&format=f64";
    let made = || {
        let answer = daemon.get("/metrics");
        let text = answer.text();
        let lines = text
            .lines()
            .filter(|line| line.starts_with("strew_points_total{"));
        let numbers = lines.filter_map(|line| line.rsplit_once(' ')?.1.parse::<f64>().ok());
        numbers.sum::<f64>()
    };
    let part = get(&daemon, path, &[("range", "bytes=70000000-70001599")]);
    assert_eq!((part.status, part.body.len()), (206, 1600));
    assert!(made() <= 101.0, "{}", made());
}
