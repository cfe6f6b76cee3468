//! HTTP around the answers: HEAD, pages of other origins, errors that are problems whoever finds
//! them.

use crate::{daemon::Daemon, raw};

const POINTS: &str = "/v1/points?bbox=0,0,10,10&density=1&profile=test&format=";

#[test]
fn head_is_get_without_a_body() {
    let daemon = Daemon::start(&[]);
    let paths = ["json", "ndjson", "csv", "f32", "f64"].map(|format| format!("{POINTS}{format}"));
    let mut paths: Vec<String> = paths.into();
    paths.extend(
        [
            "/v1/points?bbox=1,1,0,0&density=1&profile=test",
            "/v1/profiles",
            "/v1/profiles/test",
            "/v1/profiles/test/spectrum.svg",
            "/openapi.json",
            "/docs",
            "/",
            "/page/main.js",
            "/livez",
            "/readyz",
            "/nothing",
        ]
        .map(Into::into),
    );
    for path in paths {
        let get = daemon.get(&path);
        let head = raw::open(daemon.address(), "HEAD", &path, &[]);
        assert_eq!(head.status, get.status, "{path}");
        let mut expected = get.headers.clone();
        expected.remove("transfer-encoding");
        let mut got = head.headers.clone();
        for headers in [&mut expected, &mut got] {
            headers.remove("date");
            headers.remove("transfer-encoding");
            // Each request has a name of its own.
            assert!(headers.remove("x-request-id").is_some(), "{path}");
        }
        assert_eq!(got, expected, "{path}");
        assert_eq!(head.rest(), "", "{path}");
    }
    assert_eq!(daemon.streams(), 0);
}

#[test]
fn pages_of_any_origin_may_ask_and_read_all_headers() {
    let daemon = Daemon::start(&[]);
    let origin = ("origin", "https://page.example");
    for path in [
        format!("{POINTS}csv"),
        "/v1/points".into(),
        "/nothing".into(),
    ] {
        let answer = raw::get(daemon.address(), &path, &[origin]);
        assert_eq!(answer.header("access-control-allow-origin"), "*", "{path}");
        assert_eq!(answer.header("access-control-expose-headers"), "*");
        assert_eq!(answer.header("access-control-allow-credentials"), "");
        let asks = [
            origin,
            ("access-control-request-method", "GET"),
            ("access-control-request-headers", "if-none-match"),
        ];
        let allowed = raw::request(daemon.address(), "OPTIONS", &path, &asks);
        assert_eq!(allowed.status, 204, "{path}");
        assert_eq!(allowed.header("access-control-allow-origin"), "*");
        let methods = allowed.header("access-control-allow-methods");
        assert!(methods.contains("GET") && methods.contains("POST"));
        assert_eq!(
            allowed.header("access-control-allow-headers"),
            "*, authorization"
        );
    }
    // No page asks: nobody is told.
    let plain = daemon.get("/livez");
    assert_eq!(plain.header("access-control-allow-origin"), "");
}

#[test]
fn pages_may_be_listed_or_none() {
    let daemon = Daemon::start(&["http.cors_origins=https://a.example https://b.example"]);
    let ask = |daemon: &Daemon, origin| {
        let answer = raw::get(daemon.address(), "/livez", &[("origin", origin)]);
        assert_eq!(answer.status, 200);
        answer.header("access-control-allow-origin").to_owned()
    };
    assert_eq!(ask(&daemon, "https://b.example"), "https://b.example");
    assert_eq!(ask(&daemon, "https://c.example"), "");
    assert!(daemon.get("/livez").header("vary").contains("origin"));
    let closed = Daemon::start(&["http.cors_origins="]);
    assert_eq!(ask(&closed, "https://a.example"), "");
}

#[test]
fn errors_are_problems_whoever_finds_them() {
    let daemon = Daemon::start(&["server.max_header_bytes=8192"]);
    let long = format!("/v1/points?bbox={}", "1".repeat(9000));
    let wide = "x".repeat(8200);
    let none: &[(&str, &str)] = &[];
    let cases = [
        ("GET", "/v1/profiles/%ff", none, 400),
        ("GET", "/v1/profiles/mauve", none, 404),
        ("PUT", "/v1/profiles", none, 405),
        ("GET", long.as_str(), none, 414),
        ("GET", "/strew.v1.PointService/StreamPoints", none, 415),
        ("GET", "/livez", &[("x-wide", wide.as_str())][..], 431),
    ];
    for (method, path, headers, status) in cases {
        let answer = raw::request(daemon.address(), method, path, headers);
        let shown = &path[..path.len().min(60)];
        assert_eq!(answer.status, status, "{shown}: {}", answer.text());
        let content_type = answer.header("content-type");
        assert_eq!(content_type, "application/problem+json", "{shown}");
        assert_eq!(answer.header("cache-control"), "no-store", "{shown}");
        let problem = answer.json();
        assert_eq!(problem["status"], status, "{shown}");
        for member in ["type", "title", "detail"] {
            let text = problem[member].as_str().expect("a text");
            assert!(!text.is_empty(), "{shown}: {member}");
        }
    }
}
