//! HTTP around the answers: HEAD, unknown paths and methods, and problem documents for errors of
//! every layer.

use strew_testkit::http1;

use crate::support::daemon::Daemon;

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
        let head = http1::open(daemon.address(), "HEAD", &path, &[]);
        assert_eq!(head.status, get.status, "{path}");
        let mut expected = get.headers.clone();
        expected.remove("transfer-encoding");
        let mut got = head.headers.clone();
        for headers in [&mut expected, &mut got] {
            headers.remove("date");
            headers.remove("transfer-encoding");
            // Each request has an id of its own.
            assert!(headers.remove("x-request-id").is_some(), "{path}");
        }
        assert_eq!(got, expected, "{path}");
        assert_eq!(head.raw_rest(), b"", "{path}");
    }
    assert_eq!(daemon.streams(), 0);
}

#[test]
fn errors_of_every_layer_are_problem_documents() {
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
        let answer = http1::request(daemon.address(), method, path, headers);
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

#[test]
fn unknown_paths_and_methods_are_problem_documents() {
    let daemon = Daemon::start(&[]);
    for path in [
        "/page/none.js",
        "/v1",
        "/v2/points",
        "/v1/points/",
        "/strew.v1.Nothing/X",
    ] {
        let answer = daemon.get(path);
        assert_eq!(answer.status, 404, "{path}");
        assert_eq!(answer.header("content-type"), "application/problem+json");
        assert!(answer.text().contains(path), "{path}: {}", answer.text());
    }
    for path in ["/v1/points", "/v1/profiles", "/livez", "/readyz"] {
        for method in ["POST", "DELETE", "OPTIONS"] {
            let answer = http1::request(daemon.address(), method, path, &[]);
            assert_eq!(answer.status, 405, "{method} {path}");
            let allow = answer.header("allow").replace(' ', "");
            assert_eq!(allow, "GET,HEAD", "{method} {path}");
            assert_eq!(answer.header("content-type"), "application/problem+json");
            assert!(answer.text().contains(method));
        }
    }
    let of = |method: &str, path: &str| {
        http1::request(daemon.address(), method, path, &[])
            .text()
            .to_owned()
    };
    assert!(of("POST", "/v1/points").contains("POST is for /v1/points:query"));
    let near = of("GET", "/v1/point");
    assert!(
        near.contains("/v1/points, ") && near.contains("/openapi.json"),
        "{near}"
    );
    assert!(near.len() < 400, "{near}");
    let icon = daemon.get("/favicon.ico");
    assert_eq!(
        (icon.status, icon.header("content-type")),
        (200, "image/svg+xml")
    );
    let grpc = [("content-type", "application/grpc")];
    let answer = http1::request(daemon.address(), "POST", "/strew.v1.Nothing/X", &grpc);
    assert_eq!((answer.status, answer.header("grpc-status")), (200, "12"));
}
