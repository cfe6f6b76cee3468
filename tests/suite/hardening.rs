//! What keeps mistakes small: headers for browsers, panics that stay one request's, warnings.

use std::{
    io::{BufRead as _, BufReader},
    net::TcpListener,
    process::Stdio,
};

use axum::{Router, routing};
use strew::{config::Layers, ops::App};

use crate::{
    daemon::{Daemon, strew, tables},
    keys::{entry, keys},
    raw,
};

#[test]
fn every_answer_tells_browsers_what_it_is_not() {
    let daemon = Daemon::start(&[]);
    for (path, status) in [
        ("/docs", 200),
        ("/docs/page.js", 200),
        ("/openapi.json", 200),
        ("/livez", 200),
        ("/v1/profiles", 200),
        ("/v1/profiles/test/spectrum.svg", 200),
        ("/v1/points?bbox=0,0,5,5&density=1&format=svg", 200),
        ("/v1/points?bbox=0,0,5,5", 400),
        ("/nothing", 404),
    ] {
        let answer = daemon.get(path);
        assert_eq!(answer.status, status, "{path}");
        assert_eq!(answer.header("x-content-type-options"), "nosniff", "{path}");
        assert_eq!(answer.header("referrer-policy"), "no-referrer", "{path}");
        let resource = answer.header("cross-origin-resource-policy");
        assert_eq!(resource, "cross-origin", "{path}");
        let policy = answer.header("content-security-policy");
        assert!(policy.contains("default-src 'none'"), "{path}: {policy}");
        assert!(
            policy.contains("frame-ancestors 'none'"),
            "{path}: {policy}"
        );
        let is_page = path.starts_with("/docs");
        assert_eq!(policy.contains("sandbox"), !is_page, "{path}: {policy}");
    }
    let listed = Daemon::start(&["http.cors_origins=https://a.example"]);
    let answer = listed.get("/v1/profiles");
    assert_eq!(answer.header("cross-origin-resource-policy"), "same-origin");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_panic_stays_one_requests() {
    let mut layers = Layers::new().expect("the defaults");
    for setting in ["server.listen=127.0.0.1:0", "shutdown.drain_seconds=1"] {
        layers = layers.assignment(setting).expect("a setting");
    }
    async fn panics() -> &'static str {
        panic!("as asked for: a secret of the source")
    }
    let routes = Router::new().route("/panics", routing::any(panics));
    let app = App::new(layers.finish().expect("settings"))
        .expect("tables")
        .with_routes(routes);
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address").to_string();
    let (stop, stopped) = tokio::sync::oneshot::channel::<()>();
    let running = tokio::spawn(app.run(listener, async move {
        let _ = stopped.await;
    }));
    let asked = tokio::task::spawn_blocking(move || {
        for _ in 0..3 {
            let answer = raw::get(&address, "/panics", &[]);
            assert_eq!(answer.status, 500, "{}", answer.text());
            assert_eq!(answer.header("content-type"), "application/problem+json");
            assert_eq!(answer.json()["type"], "urn:strew:problem:internal");
            assert!(!answer.text().contains("secret"), "{}", answer.text());
        }
        let call = [("content-type", "application/grpc-web")];
        let answer = raw::posted(&address, "/panics", &call, b"");
        assert_eq!(answer.header("grpc-status"), "13", "INTERNAL");
        assert_eq!(raw::get(&address, "/livez", &[]).status, 200);
    });
    asked.await.expect("in order");
    let _ = stop.send(());
    running.await.expect("no panic").expect("in order");
}

/// What a daemon says in its log before it serves.
fn first_words(settings: &[&str]) -> String {
    let folder = tables();
    let mut command = strew();
    command.args(["serve", "--tables"]).arg(folder.path());
    for setting in settings {
        command.args(["--set", setting]);
    }
    let mut child = command
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let mut said = String::new();
    for line in BufReader::new(child.stderr.take().expect("piped")).lines() {
        let line = line.expect("text");
        said += &line;
        if line.contains("serving") {
            break;
        }
    }
    let _ = child.kill();
    let _ = child.wait();
    said
}

#[test]
fn a_daemon_that_everybody_can_reach_says_so() {
    let wide = "server.listen=0.0.0.0:0";
    let said = first_words(&[wide]);
    assert!(
        said.contains("WARN") && said.contains("beyond this machine"),
        "{said}"
    );
    assert!(
        said.contains("without keys") && said.contains("access.keys_file"),
        "{said}"
    );
    // Keys alone are no secret for long.
    let said = first_words(&[wide, &keys(&entry("a", "secret", ""))]);
    assert!(said.contains("take the keys"), "{said}");
    let said = first_words(&["server.listen=127.0.0.1:0"]);
    assert!(!said.contains("WARN"), "{said}");
}
