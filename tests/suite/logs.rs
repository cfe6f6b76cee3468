//! The log: a line a request, with names that are the client's where they may be.

use std::{
    io::{BufRead as _, BufReader},
    process::{Child, Stdio},
};

use serde_json::Value;

use crate::{
    daemon::{self, strew},
    raw,
};

/// A daemon whose log is read.
struct Logged {
    child: Child,
    address: String,
    log: std::io::Lines<BufReader<std::process::ChildStderr>>,
    _tables: tempfile::TempDir,
}

impl Logged {
    fn start(settings: &[&str]) -> Self {
        let tables = daemon::tables();
        let mut command = strew();
        command
            .args(["serve", "--listen", "127.0.0.1:0", "--tables"])
            .arg(tables.path());
        for setting in settings {
            command.args(["--set", setting]);
        }
        let mut child = command
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut line = String::new();
        let out = child.stdout.take().expect("piped");
        BufReader::new(out).read_line(&mut line).expect("readable");
        let address = line
            .trim()
            .strip_prefix("listening on http://")
            .expect("ready");
        let log = BufReader::new(child.stderr.take().expect("piped")).lines();
        Self {
            address: address.into(),
            child,
            log,
            _tables: tables,
        }
    }

    /// The next line with a word in it.
    fn line(&mut self, word: &str) -> String {
        let mut lines = self.log.by_ref().map(|line| line.expect("UTF-8"));
        lines.find(|line| line.contains(word)).expect("a line")
    }

    fn json(&mut self, word: &str) -> Value {
        let line = self.line(word);
        serde_json::from_str(&line).unwrap_or_else(|e| panic!("{line}: {e}"))
    }
}

impl Drop for Logged {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

const POINTS: &str = "/v1/points?bbox=0,0,20,20&density=1&profile=test&format=csv";

#[test]
fn every_request_has_a_line_with_what_was_done() {
    let mut daemon = Logged::start(&["log.format=json"]);
    let trace = "4bf92f3577b34da6a3ce929d0e0e4736";
    let parent = format!("00-{trace}-00f067aa0ba902b7-01");
    let headers = [("x-request-id", "mine-7"), ("traceparent", parent.as_str())];
    let answer = raw::get(&daemon.address, POINTS, &headers);
    assert_eq!(answer.header("x-request-id"), "mine-7");
    let line = daemon.json("strew::access");
    let text = |name: &str| line[name].as_str().unwrap_or_default().to_owned();
    assert_eq!(text("request_id"), "mine-7");
    assert_eq!(text("trace_id"), trace);
    assert_eq!(text("parent_id"), "00f067aa0ba902b7");
    assert_eq!(text("span_id").len(), 16);
    assert_eq!((&*text("level"), &*text("door")), ("INFO", "rest"));
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
    // An id that would mangle the log is replaced, a trace out of order left out.
    let headers = [
        ("x-request-id", "a\" level=\"x"),
        ("traceparent", "00-0-0-0"),
    ];
    let answer = raw::get(&daemon.address, POINTS, &headers);
    let line = daemon.json("strew::access");
    assert_eq!(line["request_id"], answer.header("x-request-id"));
    assert_eq!(answer.header("x-request-id").len(), 16);
    assert!(line.get("trace_id").is_none(), "{line}");
}

#[test]
fn errors_say_what_they_are_called_in_the_log() {
    let mut daemon = Logged::start(&["log.format=json"]);
    for (path, reason) in [
        ("/v1/points?bbox=0", Some("invalid-query")),
        ("/nothing", Some("no-such-path")),
        ("/v1/profiles/%ff", None),
    ] {
        let answer = raw::get(&daemon.address, path, &[]);
        let id = answer.header("x-request-id");
        assert_eq!(answer.json()["request_id"], id, "{path}");
        let line = daemon.json("strew::access");
        assert_eq!(line["request_id"], id, "{path}");
        assert_eq!(line["reason"].as_str(), reason, "{path}");
    }
    let call = [
        ("content-type", "application/grpc-web+proto"),
        ("x-request-id", "c1"),
    ];
    let path = "/strew.v1.PointService/StreamPoints";
    let answer = raw::posted(&daemon.address, path, &call, &[0; 5]);
    assert_eq!(answer.header("x-request-id"), "c1");
    let line = daemon.json("strew::access");
    assert_eq!(
        (&line["door"], &line["outcome"]),
        (&"grpc".into(), &"INVALID_ARGUMENT".into())
    );
    assert_eq!(
        (&line["request_id"], &line["route"]),
        (&"c1".into(), &path.into())
    );
}

#[test]
fn lines_for_people_name_requests_too_and_probes_are_quiet() {
    let mut daemon = Logged::start(&[]);
    for path in ["/livez", "/readyz", "/metrics"] {
        assert_eq!(raw::get(&daemon.address, path, &[]).status, 200);
    }
    raw::get(&daemon.address, POINTS, &[("x-request-id", "mine-8")]);
    // The first line of the kind is not that of a probe.
    let line = daemon.line("strew::access");
    assert!(
        line.contains("INFO") && line.contains("request_id=\"mine-8\""),
        "{line}"
    );
    assert!(serde_json::from_str::<Value>(&line).is_err());
}
