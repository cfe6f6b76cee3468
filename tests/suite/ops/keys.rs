//! API keys: REST and gRPC require one, and each has the limits of its entry.

use std::{fs, path::Path, process::Output};

use strew::grpc::proto::{ListProfilesRequest, point_service_client::PointServiceClient};
use strew_service::access::Hashed;
use strew_testkit::{http1, tables::write, wait::until};
use tonic::{Code, Request};
use tonic_health::pb::{HealthCheckRequest, health_client::HealthClient};
use tonic_types::StatusExt as _;

use crate::support::{
    daemon::{Daemon, strew, table, tables},
    grpc::square,
    keys::{entry, get_with_key, keys},
    queries::long,
};

const POINTS: &str = "/v1/points?bbox=0,0,9,9&density=1&profile=test&format=csv";

fn bearer(key: &str) -> String {
    format!("Bearer {key}")
}

#[test]
fn rest_requires_a_key() {
    let daemon = Daemon::start(&[&keys(&entry("a", "secret", ""))]);
    let address = daemon.address();
    for path in [
        "/livez",
        "/readyz",
        "/docs",
        "/page/docs/docs.js",
        "/openapi.json",
    ] {
        assert_eq!(daemon.get(path).status, 200, "{path}");
    }
    for path in [
        POINTS,
        "/v1/points?nonsense",
        "/v1/chunks/8/0/0?density=1",
        "/v1/count?bbox=0,0,9,9&density=1",
        "/v1/points/8:-1?spacing=1",
        "/v1/nearest?at=0,0&spacing=1",
        "/v1/profiles",
        "/v1/profiles/test",
        "/v1/profiles/test/spectrum.svg",
    ] {
        let refused = daemon.get(path);
        assert_eq!(refused.status, 401, "{path}: {}", refused.text());
        assert_eq!(refused.header("www-authenticate"), "Bearer realm=\"strew\"");
        assert_eq!(refused.header("content-type"), "application/problem+json");
        assert_eq!(refused.header("cache-control"), "no-store");
        let problem = refused.json();
        assert_eq!(problem["type"], "urn:strew:problem:unauthenticated");
    }
    for path in [
        "/v1/points:query",
        "/v1/count",
        "/v1/points:split?parts=2",
        "/v1/tables:reload",
    ] {
        let refused = daemon.post(path, &serde_json::json!({}));
        assert_eq!(refused.status, 401, "{path}: {}", refused.text());
    }
    let right = bearer("secret");
    for headers in [
        &[("authorization", right.as_str())],
        &[("authorization", "bearer  secret")],
        &[("x-api-key", "secret")],
    ] {
        let answer = http1::get(address, POINTS, headers);
        assert_eq!(answer.status, 200, "{}", answer.text());
        // Shared caches must not serve it to others.
        assert_eq!(answer.header("cache-control"), "private, max-age=300");
        let pinned = format!("{POINTS}&table={}", answer.header("strew-table"));
        let pinned = http1::get(address, &pinned, headers);
        let kept = pinned.header("cache-control");
        assert_eq!(kept, "private, max-age=31536000, immutable");
    }
    let hash = Hashed::of(b"secret").to_string();
    for (name, value) in [
        ("x-api-key", "Secret"),
        ("x-api-key", ""),
        ("x-api-key", hash.as_str()),
        ("authorization", "Bearer secret2"),
    ] {
        let refused = http1::get(address, POINTS, &[(name, value)]);
        assert_eq!(refused.status, 401, "{name}: {value}");
        assert!(refused.header("www-authenticate").contains("invalid_token"));
        assert!(!refused.text().contains(&hash));
    }
    let basic = http1::get(address, POINTS, &[("authorization", "Basic c2VjcmV0")]);
    assert_eq!(basic.status, 401);
    // Pages of other origins may send a key.
    let asks = [
        ("origin", "https://a.example"),
        ("access-control-request-method", "GET"),
    ];
    let preflight = http1::request(address, "OPTIONS", POINTS, &asks);
    assert_eq!(preflight.status, 204);
    let allowed = preflight.header("access-control-allow-headers");
    assert!(allowed.contains("authorization"), "{allowed}");
}

#[tokio::test(flavor = "multi_thread")]
async fn grpc_requires_a_key() {
    let daemon = Daemon::start(&[&keys(&entry("a", "secret", "max_points = 100"))]);
    let channel = daemon.channel().await;
    let mut client = PointServiceClient::new(channel.clone());
    let refused = client.list_profiles(ListProfilesRequest {}).await;
    assert_eq!(refused.expect_err("no key").code(), Code::Unauthenticated);
    let box_of = |side: f64, key: Option<&'static str>| {
        let mut request = Request::new(square(side));
        if let Some(key) = key {
            let value = bearer(key).parse().expect("text");
            request.metadata_mut().insert("authorization", value);
        }
        request
    };
    for (key, reason) in [
        (None, "UNAUTHENTICATED"),
        (Some("wrong"), "UNAUTHENTICATED"),
    ] {
        let status = client
            .stream_points(box_of(5.0, key))
            .await
            .expect_err("no key");
        assert_eq!(status.code(), Code::Unauthenticated, "{status:?}");
        let details = status.get_error_details();
        assert_eq!(details.error_info().expect("details").reason, reason);
    }
    assert!(
        client
            .stream_points(box_of(5.0, Some("secret")))
            .await
            .is_ok()
    );
    let over = client.stream_points(box_of(20.0, Some("secret"))).await;
    let over = over.expect_err("too many");
    assert_eq!(over.code(), Code::ResourceExhausted);
    let details = over.get_error_details();
    assert_eq!(
        details.error_info().expect("details").metadata["limit"],
        "100"
    );
    // Health checks need no key.
    let health = HealthClient::new(channel)
        .check(HealthCheckRequest::default())
        .await;
    assert!(health.is_ok(), "{health:?}");
}

#[test]
fn a_key_has_limits_of_its_own() {
    let entries = [
        entry("small", "s", "max_points = 50\nmax_streams = 1"),
        entry("large", "l", ""),
    ];
    let daemon = Daemon::start(&[&keys(&entries.concat())]);
    let refused = get_with_key(&daemon, POINTS, "s");
    assert_eq!(refused.status, 413, "{}", refused.text());
    assert_eq!(refused.json()["limit"], 50);
    assert_eq!(get_with_key(&daemon, POINTS, "l").status, 200);
    assert_eq!(
        get_with_key(&daemon, "/v1/points?bbox=0,0,5,5&density=1", "s").status,
        200
    );

    let daemon = Daemon::start(&[&keys(
        &[entry("few", "f", "max_streams = 1"), entry("many", "m", "")].concat(),
    )]);
    let path = long("f32");
    let open = |key: &str| http1::open(daemon.address(), "GET", &path, &[("x-api-key", key)]);
    let first = open("f");
    assert_eq!(first.status, 200);
    let second = get_with_key(&daemon, &path, "f");
    assert_eq!(second.status, 429, "{}", second.text());
    assert_eq!(second.header("retry-after"), "1");
    assert_eq!(second.json()["limit"], 1);
    assert_eq!(second.json()["type"], "urn:strew:problem:too-many-streams");
    let others = [open("m"), open("m")];
    assert!(others.iter().all(|other| other.status == 200));
    drop(first);
    until("the stream is free", || open("f").status == 200);
}

fn new_key(arguments: &[&str]) -> Output {
    let mut command = strew();
    command.args(["key", "new"]).args(arguments);
    command.output().expect("the program runs")
}

#[test]
fn a_new_key_is_shown_once_and_its_entry_admits_it() {
    let limits = [
        "--max-points",
        "60",
        "--max-streams",
        "2",
        "--points-per-second",
        "1e5",
    ];
    let made = new_key(&[&["game", "--admin"], &limits[..]].concat());
    assert!(made.status.success());
    let [entry, message] =
        [made.stdout, made.stderr].map(|bytes| String::from_utf8(bytes).expect("text"));
    let key = message.lines().last().expect("the key");
    assert!(key.starts_with("strew_") && key.len() == 70, "{message}");
    assert!(!entry.contains(key));
    for line in [
        "name = \"game\"",
        "admin = true",
        "max_points = 60",
        "max_streams = 2",
    ] {
        assert!(entry.contains(line), "{entry}");
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("keys.toml");
    fs::write(&file, &entry).expect("writable");
    let daemon = Daemon::start(&[&format!("access.keys_file={}", file.display())]);
    assert_eq!(daemon.get(POINTS).status, 401);
    assert_eq!(get_with_key(&daemon, POINTS, key).status, 413);
    let few = get_with_key(&daemon, "/v1/points?bbox=0,0,5,5&density=1", key);
    assert_eq!(few.status, 200);
    assert_eq!(few.header("ratelimit-policy"), "\"points\";q=1000000;w=10");
    let other = new_key(&["game"]);
    assert!(!String::from_utf8_lossy(&other.stderr).contains(key));
    for wrong in [
        &["a b"][..],
        &[""],
        &["a", "--max-points", "0"],
        &["a", "--points-per-second", "0"],
    ] {
        let refused = new_key(wrong);
        assert_eq!(refused.status.code(), Some(2), "{wrong:?}");
        assert!(refused.stdout.is_empty());
    }
}

#[test]
fn keys_are_added_and_removed_while_the_daemon_serves() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("keys.toml");
    let write_keys = |text: &str| fs::write(&file, text).expect("writable");
    write_keys(&entry("a", "one", ""));
    let setting = format!("access.keys_file={}", file.display());
    let daemon = Daemon::start(&[&setting, "reload.watch_seconds=0.05"]);
    let is_in = |key: &str| get_with_key(&daemon, POINTS, key).status == 200;
    assert!(is_in("one") && !is_in("two"));
    write_keys(&[entry("a", "one", ""), entry("b", "two", "")].concat());
    until("a key is added", || is_in("two"));
    write_keys(&entry("b", "two", ""));
    until("a key is removed", || !is_in("one"));
    // An invalid file changes nothing.
    let daemon = Daemon::start(&[&setting, "reload.watch_seconds=0"]);
    let is_in = |key: &str| get_with_key(&daemon, POINTS, key).status == 200;
    for wrong in ["[[key]", "[[key]]\nname = 'a'\nhash = 'a'"] {
        write_keys(wrong);
        let new = table("sqrt(3)", &format!("new{}", wrong.len()));
        write(daemon.folder(), "new.strew", &new);
        daemon.signal("HUP");
        let path = format!(
            "/v1/count?bbox=0,0,5,5&density=1&alpha=sqrt(3)&profile=new{}",
            wrong.len()
        );
        until("the file has been read", || {
            get_with_key(&daemon, &path, "two").status == 200
        });
        assert!(is_in("two") && !is_in("one"));
    }
    write_keys(&entry("a", "one", ""));
    daemon.signal("HUP");
    until("a valid file is applied", || is_in("one"));
}

#[test]
fn a_file_that_holds_no_key_any_more_admits_nobody() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("keys.toml");
    let write_keys = |text: &str| fs::write(&file, text).expect("writable");
    write_keys(&entry("a", "one", ""));
    let setting = format!("access.keys_file={}", file.display());
    let daemon = Daemon::start(&[&setting, "reload.watch_seconds=0.05"]);
    let with_key = || get_with_key(&daemon, POINTS, "one").status;
    let empty: [&dyn Fn(); 3] = [&|| write_keys(""), &|| write_keys("# none left\n"), &|| {
        fs::remove_file(&file).expect("removed")
    }];
    for empty in empty {
        assert_eq!(with_key(), 200);
        empty();
        until("the key is not valid", || with_key() == 401);
        // It never falls open.
        assert_eq!(daemon.get(POINTS).status, 401);
        write_keys(&entry("a", "one", ""));
        until("the key is valid again", || with_key() == 200);
    }
}

#[test]
fn anonymous_clients_can_be_admitted_as_well() {
    let entries = keys(&entry("a", "secret", ""));
    let daemon = Daemon::start(&[&entries, "access.anonymous=true"]);
    assert_eq!(daemon.get(POINTS).status, 200);
    assert_eq!(get_with_key(&daemon, POINTS, "secret").status, 200);
    // A wrong key is an error even so: its owner expects the limits of the key.
    assert_eq!(get_with_key(&daemon, POINTS, "wrong").status, 401);
    // A daemon without keys ignores those that clients present.
    let open = Daemon::start(&[]);
    assert_eq!(get_with_key(&open, POINTS, "anything").status, 200);
    assert_eq!(
        open.get(POINTS).header("cache-control"),
        "public, max-age=300"
    );
}

#[test]
fn a_daemon_does_not_start_with_invalid_access_settings() {
    let folder = tables();
    let absent = folder.path().join("absent.toml");
    let absent = format!("access.keys_file={}", absent.display());
    let start = |setting: &str, tables: &Path| {
        let mut command = strew();
        command.args([
            "serve",
            "--listen",
            "127.0.0.1:0",
            "--set",
            setting,
            "--tables",
        ]);
        let output = command.arg(tables).output().expect("the program runs");
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    for (setting, words) in [
        (absent.as_str(), "absent.toml"),
        ("access.keys=# none", "no key"),
        (
            "access.keys=[[key]]\nname='x'\nhash='1'",
            "64 hexadecimal digits",
        ),
        (
            "access.trusted_proxies=10.0.0.0/8 proxy",
            "access.trusted_proxies",
        ),
        ("admin.listen=here", "admin.listen"),
        ("rate.points_per_second=-1", "rate.points_per_second"),
        ("rate.max_clients=0", "rate.max_clients"),
    ] {
        let (code, message) = start(setting, folder.path());
        assert_eq!(code, Some(2), "{setting}: {message}");
        assert!(message.contains(words), "{setting}: {message}");
    }
}
