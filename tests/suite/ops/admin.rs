//! Reloads on request: only with the key of an administrator or over their own address.

use std::net::SocketAddr;

use serde_json::{Value, json};
use strew_testkit::{http1, tables::write};

use crate::support::{
    daemon::{Daemon, PROFILE, table},
    keys::{entry, keys},
};

const RELOAD: &str = "/v1/tables:reload";

fn reload(address: SocketAddr, headers: &[(&str, &str)]) -> http1::Answer {
    http1::post(address, RELOAD, headers, b"")
}

fn sources(list: &Value) -> Vec<String> {
    let names = list.as_array().expect("a list").iter().map(|item| {
        let source = item["source"].as_str().expect("a text");
        source.rsplit('/').next().expect("a name").to_owned()
    });
    names.filter(|name| !name.starts_with("built-in")).collect()
}

#[test]
fn a_reload_needs_an_admin_key_or_the_admin_address() {
    let daemon = Daemon::start(&[]);
    let refused = reload(daemon.address(), &[]);
    assert_eq!(refused.status, 403, "{}", refused.text());
    let problem = refused.json();
    assert_eq!(problem["type"], "urn:strew:problem:not-allowed");
    let detail = problem["detail"].as_str().expect("a text");
    assert!(
        detail.contains("admin = true") && detail.contains("admin.listen"),
        "{detail}"
    );
    assert_eq!(daemon.get(RELOAD).status, 405);
}

#[test]
fn an_admin_key_reloads_and_gets_a_report() {
    let entries = [entry("user", "u", ""), entry("root", "r", "admin = true")].concat();
    let daemon = Daemon::start(&[&keys(&entries), "reload.watch_seconds=0"]);
    let address = daemon.address();
    assert_eq!(reload(address, &[]).status, 401);
    let refused = reload(address, &[("x-api-key", "u")]);
    assert_eq!(refused.status, 403);
    assert!(
        refused.text().contains("the key `user`"),
        "{}",
        refused.text()
    );

    let root = [("x-api-key", "r")];
    let first = reload(address, &root).json();
    assert_eq!(sources(&first["kept"]), ["a.strew", "b.strew"]);
    assert_eq!(first["loaded"], Value::Array(vec![]));
    assert_eq!(first["keys"], 2);
    write(daemon.folder(), "c.strew", &table("sqrt(3)", "new"));
    std::fs::write(daemon.folder().join("b.strew"), "nonsense").expect("writable");
    let second = reload(address, &root).json();
    assert_eq!(sources(&second["loaded"]), ["c.strew"]);
    assert_eq!(sources(&second["kept"]), ["a.strew", "b.strew"]);
    assert_eq!(sources(&second["refused"]), ["b.strew"]);
    let refusal = &second["refused"][0];
    assert_eq!(
        refusal["serving"],
        table("sqrt(3)", PROFILE).digest().to_string()
    );
    let detail = refusal["detail"].as_str().expect("a text");
    assert!(detail.contains("not a Strew table"), "{detail}");
    std::fs::remove_file(daemon.folder().join("b.strew")).expect("removable");
    let third = reload(address, &root).json();
    assert_eq!(sources(&third["removed"]), ["b.strew"]);
    assert_eq!(third["refused"], Value::Array(vec![]));
}

#[test]
fn the_admin_address_needs_no_key() {
    let mut daemon = Daemon::start(&["admin.listen=127.0.0.1:0"]);
    let line = daemon.line();
    let admin = line.strip_prefix("administrators on http://").expect(&line);
    let admin = admin.parse().expect("an address");
    let done = reload(admin, &[]);
    assert_eq!(done.status, 200, "{}", done.text());
    assert_eq!(done.header("cache-control"), "no-store");
    assert_eq!(done.json()["keys"], Value::Null);
    assert_eq!(http1::get(admin, "/livez", &[]).status, 200);
    // The address serves nothing else, and the public one refuses as before.
    assert_eq!(http1::get(admin, "/v1/profiles", &[]).status, 404);
    assert_eq!(reload(daemon.address(), &[]).status, 403);
    // A page in an administrator's browser may not reload.
    let page = reload(admin, &[("origin", "https://page.example")]);
    assert_eq!(page.status, 403, "{}", page.text());
    daemon.terminate();
    assert_eq!(daemon.wait().code(), Some(0));
}

#[test]
fn pages_whose_name_was_turned_to_this_machine_are_refused_by_every_port_and_protocol() {
    let daemon = Daemon::start(&["admin.listen=127.0.0.1:0", "http.cors_origins="]);
    let line = daemon.line();
    let admin = line.strip_prefix("administrators on http://").expect(&line);
    let admin = admin.parse().expect("an address");
    let call = ("content-type", "application/grpc-web+proto");
    let check = "/grpc.health.v1.Health/Check";
    let frame = [0; 5];
    let evil = [
        ("host", "evil.example:8080"),
        ("origin", "http://evil.example:8080"),
    ];
    for address in [daemon.address(), admin] {
        for (method, path) in [
            ("GET", "/metrics"),
            ("GET", "/"),
            ("OPTIONS", "/metrics"),
            ("POST", RELOAD),
        ] {
            let refused = http1::request(address, method, path, &evil);
            assert_eq!(refused.status, 421, "{method} {path}: {}", refused.text());
            let problem = refused.json();
            assert_eq!(problem["type"], "urn:strew:problem:misdirected");
            let detail = problem["detail"].as_str().expect("a text");
            assert!(
                detail.contains("`evil.example:8080`") && detail.contains("http.public_url"),
                "{detail}"
            );
        }
        for host in ["localhost", "127.0.0.1:1", "[::1]", "strew.localhost"] {
            let answer = http1::request(address, "GET", "/metrics", &[("host", host)]);
            assert_eq!(answer.status, 200, "{host}");
        }
    }
    let count =
        json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1, "profile": "test" }).to_string();
    let posted = http1::post(daemon.address(), "/v1/count", &evil, count.as_bytes());
    assert_eq!(posted.status, 421);
    let calls = [&[call], &evil[..]].concat();
    let called = http1::open_post(daemon.address(), check, &calls, &frame);
    assert_eq!(called.headers["grpc-status"], "7", "{:?}", called.headers);
    // The daemon's own pages.
    let own = format!("http://{}", daemon.address());
    let own = [("origin", own.as_str())];
    assert_eq!(
        http1::post(daemon.address(), "/v1/count", &own, count.as_bytes()).status,
        200
    );
    let other = [("origin", "http://127.0.0.1:1")];
    assert_eq!(
        http1::post(daemon.address(), "/v1/count", &other, count.as_bytes()).status,
        403
    );
}
