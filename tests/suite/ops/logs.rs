//! The log: one line for each request, with the client's ids where they are valid.

use serde_json::Value;
use strew_testkit::http1;

use crate::support::daemon::Daemon;

/// The next line of the log that contains `part`, which must be JSON.
fn json_line(daemon: &Daemon, part: &str) -> Value {
    let line = daemon.log_line(part);
    serde_json::from_str(&line).unwrap_or_else(|e| panic!("{line}: {e}"))
}

const POINTS: &str = "/v1/points?bbox=0,0,20,20&density=1&profile=test&format=csv";

#[test]
fn every_request_is_logged_with_its_outcome() {
    let daemon = Daemon::with_log(&["log.format=json"]);
    let trace = "4bf92f3577b34da6a3ce929d0e0e4736";
    let parent = format!("00-{trace}-00f067aa0ba902b7-01");
    let headers = [("x-request-id", "mine-7"), ("traceparent", parent.as_str())];
    let answer = http1::get(daemon.address(), POINTS, &headers);
    assert_eq!(answer.header("x-request-id"), "mine-7");
    let line = json_line(&daemon, "strew::access");
    let text = |name: &str| line[name].as_str().unwrap_or_default().to_owned();
    assert_eq!(text("request_id"), "mine-7");
    assert_eq!(text("trace_id"), trace);
    assert_eq!(text("parent_id"), "00f067aa0ba902b7");
    assert_eq!(text("span_id").len(), 16);
    assert_eq!((&*text("level"), &*text("protocol")), ("INFO", "rest"));
    assert_eq!((&*text("method"), &*text("route")), ("GET", "/v1/points"));
    assert_eq!(
        (text("address"), &*text("format")),
        (POINTS.to_owned(), "csv")
    );
    assert_eq!(line["status"], 200);
    assert_eq!(line["points"].to_string(), answer.header("strew-count"));
    assert_eq!(line["bytes"], answer.body.len());
    assert!(text("client").starts_with("127.0.0.1:"), "{line}");
    assert!(line["first_byte_ms"].as_f64() > Some(0.0), "{line}");
    assert!(line["total_ms"].as_f64() >= line["first_byte_ms"].as_f64());
    assert!(
        line.get("broken").is_none() && line.get("reason").is_none(),
        "{line}"
    );
    // An id that would garble the log is replaced; an invalid trace is left out.
    let headers = [
        ("x-request-id", "a\" level=\"x"),
        ("traceparent", "00-0-0-0"),
    ];
    let answer = http1::get(daemon.address(), POINTS, &headers);
    let line = json_line(&daemon, "strew::access");
    assert_eq!(line["request_id"], answer.header("x-request-id"));
    assert_eq!(answer.header("x-request-id").len(), 16);
    assert!(line.get("trace_id").is_none(), "{line}");
}

#[test]
fn errors_and_their_lines_share_a_request_id() {
    let daemon = Daemon::with_log(&["log.format=json"]);
    for (path, reason) in [
        ("/v1/points?bbox=0", Some("invalid-query")),
        ("/nothing", Some("no-such-path")),
        ("/v1/profiles/%ff", None),
    ] {
        let answer = http1::get(daemon.address(), path, &[]);
        let id = answer.header("x-request-id");
        assert_eq!(answer.json()["request_id"], id, "{path}");
        let line = json_line(&daemon, "strew::access");
        assert_eq!(line["request_id"], id, "{path}");
        assert_eq!(line["reason"].as_str(), reason, "{path}");
    }
    let call = [
        ("content-type", "application/grpc-web+proto"),
        ("x-request-id", "c1"),
    ];
    let path = "/strew.v1.PointService/StreamPoints";
    let answer = http1::post(daemon.address(), path, &call, &[0; 5]);
    assert_eq!(answer.header("x-request-id"), "c1");
    let line = json_line(&daemon, "strew::access");
    assert_eq!(
        (&line["protocol"], &line["outcome"]),
        (&"grpc".into(), &"INVALID_ARGUMENT".into())
    );
    assert_eq!(
        (&line["request_id"], &line["route"]),
        (&"c1".into(), &path.into())
    );
}

#[test]
fn text_lines_have_request_ids_and_probes_are_not_logged() {
    let daemon = Daemon::with_log(&[]);
    for path in ["/livez", "/readyz", "/metrics"] {
        assert_eq!(http1::get(daemon.address(), path, &[]).status, 200);
    }
    http1::get(daemon.address(), POINTS, &[("x-request-id", "mine-8")]);
    // The first access line is not that of a probe.
    let line = daemon.log_line("strew::access");
    assert!(
        line.contains("INFO") && line.contains("request_id=\"mine-8\""),
        "{line}"
    );
    assert!(serde_json::from_str::<Value>(&line).is_err());
}

#[test]
fn keys_in_an_address_reach_neither_log_nor_answer() {
    let daemon = Daemon::with_log(&["log.format=json", "log.filter=trace"]);
    let key = "strew_0123456789abcdef";
    for (path, shown) in [
        (
            format!("{POINTS}&x-api-key={key}"),
            format!("{POINTS}&x-api-key=***"),
        ),
        (
            format!("{POINTS}&key=secret-7-secret"),
            format!("{POINTS}&key=***"),
        ),
        (
            format!("{POINTS}&seed=%73trew_0123456789abcdef"),
            format!("{POINTS}&seed=***"),
        ),
        (
            format!("/v1/points/{key}?spacing=1"),
            "/v1/points/***?spacing=1".into(),
        ),
        (format!("/{key}"), "/***".into()),
    ] {
        let answer = daemon.get(&path);
        assert!((400..500).contains(&answer.status), "{path}");
        let line = json_line(&daemon, "strew::access");
        assert_eq!(line["address"], shown);
        for secret in ["0123456789abcdef", "secret-7-secret"] {
            assert!(!answer.text().contains(secret), "{}", answer.text());
        }
    }
    let log = daemon.log();
    for secret in ["0123456789abcdef", "secret-7-secret"] {
        assert!(!log.contains(secret), "{log}");
    }
}
