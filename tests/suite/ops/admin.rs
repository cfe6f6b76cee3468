//! Reloads on request: only with the key of an administrator or over their own address.

use std::net::SocketAddr;

use serde_json::{Value, json};
use strew_core::space;
use strew_testkit::{daemon::Launcher, http1, tables::write};

use crate::support::{
    daemon::{Daemon, PROFILE, PROGRAM, table, tables},
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

/// The address of administrators in the line that announces it.
fn admin(line: &str) -> SocketAddr {
    let address = line.strip_prefix("administrators on http://");
    address.expect(line).parse().expect("an address")
}

#[test]
fn the_admin_address_needs_no_key() {
    let mut daemon = Daemon::start(&["admin.listen=127.0.0.1:0"]);
    let admin = admin(&daemon.line());
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

#[test]
fn the_start_readiness_and_a_reload_count_the_same_tables() {
    let folder = tables();
    let alpha = "sqrt(3)".parse().expect("a number");
    let in_space = space::Table::undisplaced(alpha, 5, "test").expect("a table");
    std::fs::write(folder.path().join("c.strew"), in_space.to_bytes()).expect("writable");
    let launcher = Launcher::new(PROGRAM).tables(folder.path());
    let launcher = launcher.settings(&["admin.listen=127.0.0.1:0", "reload.watch_seconds=0"]);
    let daemon = launcher.start().expect("ready");
    let admin = admin(&daemon.line());
    let ready = || http1::get(admin, "/readyz", &[]).json()["tables"].clone();
    let start = daemon.log_line("serving");
    let tables = format!(" tables={} threads", ready());
    assert!(start.contains(&tables), "{start}");
    // The file is gone; then the folder, whose tables stay.
    for gone in [folder.path().join("c.strew"), folder.path().to_owned()] {
        let before = ready().as_u64().expect("a number");
        std::fs::rename(&gone, gone.with_extension("gone")).expect("renamed");
        let done = reload(admin, &[]).json();
        let number = |list: &str| done[list].as_array().expect("a list").len() as u64;
        assert_eq!(number("kept") + number("removed"), before);
        assert_eq!([&done["tables"], &json!(number("kept"))], [&ready(); 2]);
        let refused = number("refused");
        daemon.log_line(&format!("refused={refused} tables={}", ready()));
    }
    std::fs::rename(folder.path().with_extension("gone"), folder.path()).expect("renamed");
}

#[test]
fn a_reload_names_the_settings_that_wait_for_the_next_start() {
    let folder = tables();
    let file = folder.path().join("strew.toml");
    let write = |text: &str| std::fs::write(&file, text).expect("writable");
    write("limits.max_points = 5\nshutdown.drain_seconds = 9");
    let settings = ["admin.listen=127.0.0.1:0", "limits.max_rows=99"];
    let launcher = Launcher::new(PROGRAM).config(&file).settings(&settings);
    let daemon = launcher.settings(&["reload.watch_seconds=0"]).start();
    let daemon = daemon.expect("ready");
    let (admin, public) = (admin(&daemon.line()), daemon.address());
    let waiting = |words: &str| {
        daemon.signal("HUP");
        daemon.log_line(words);
        let field = "/v1/count?bbox=0,0,1,1&spacing=1&field=glade";
        (
            reload(admin, &[]).json(),
            http1::get(public, field, &[]).status,
        )
    };
    write("limits.max_points = 6");
    let (both, _) = waiting(
        "limits.max_points and shutdown.drain_seconds changed; they take effect at the next",
    );
    assert_eq!(
        both["at_next_start"],
        json!(["limits.max_points", "shutdown.drain_seconds"])
    );
    // What a flag has set stays so, 9 is 9.0, and a field is taken at once.
    let field = "[fields.glade]\nradial = { center = [0, 0], radii = [20, 50] }";
    write(&format!(
        "limits = {{ max_points = 6, max_rows = 7 }}\nshutdown.drain_seconds = 9.0\n{field}"
    ));
    let (one, status) = waiting("limits.max_points changed; it takes effect at the next start");
    assert_eq!(
        (&one["at_next_start"], status),
        (&json!(["limits.max_points"]), 200)
    );
    // A file that cannot be read is named, and everything goes on as before.
    for (text, words) in [
        ("limits.max_points = 0", "max_points = 0; allowed: 1 to"),
        ("[limits", "is not valid TOML"),
    ] {
        write(text);
        let (refused, status) = waiting(words);
        assert_eq!(
            (sources(&refused["refused"]).join(" "), status),
            ("strew.toml".into(), 200)
        );
    }
    std::fs::remove_file(&file).expect("removable");
    assert_eq!(waiting("cannot read the configuration file").1, 200);
}
