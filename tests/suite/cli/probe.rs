//! `strew probe`, which health checks of containers run.

use std::{
    io::Write as _,
    net::TcpListener,
    time::{Duration, Instant},
};

use strew_testkit::{
    certificates::{Authority, self_signed},
    wait::until,
};

use crate::support::daemon::{Daemon, strew};

/// Runs `strew probe`. Returns the exit code and the message.
fn probe(arguments: &[&str]) -> (Option<i32>, String) {
    let output = strew().arg("probe").args(arguments).output();
    let output = output.expect("the program runs");
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    (output.status.code(), message)
}

#[test]
fn a_daemon_that_serves_is_ready_and_one_that_stops_is_not() {
    let daemon = Daemon::start(&["shutdown.notice_seconds=20"]);
    let url = daemon.url("");
    assert_eq!(probe(&["--url", &url]), (Some(0), String::new()));
    assert_eq!(probe(&["--url", &url, "--live"]), (Some(0), String::new()));
    // Proxies are for other machines.
    let beside = strew()
        .args(["probe", "--url", &url])
        .envs(["http_proxy", "HTTP_PROXY", "ALL_PROXY"].map(|name| (name, "http://127.0.0.1:1")))
        .output();
    assert!(beside.expect("the program runs").status.success());
    // Without a URL it uses the address of the settings.
    assert_eq!(
        probe(&["--listen", &daemon.address().to_string()]).0,
        Some(0)
    );
    daemon.terminate();
    let message = until("it is not ready", || {
        let (code, message) = probe(&["--url", &url, "--ready"]);
        (code == Some(1)).then_some(message)
    });
    assert!(message.contains("not ready: status 503"), "{message}");
    assert_eq!(probe(&["--url", &url, "--live"]).0, Some(0));
}

#[test]
fn an_address_without_a_daemon_is_reported_in_time() {
    let silent = TcpListener::bind("127.0.0.1:0").expect("a port");
    let url = format!("http://{}", silent.local_addr().expect("bound"));
    let start = Instant::now();
    let (code, message) = probe(&["--url", &url, "--timeout", "0.2"]);
    assert_eq!(code, Some(1));
    assert!(message.contains("no answer within 200ms"), "{message}");
    let encrypted = url.replace("http", "https");
    let (code, message) = probe(&["--url", &encrypted, "--insecure", "--timeout", "0.2"]);
    assert_eq!(code, Some(1));
    assert!(message.contains("no answer within 200ms"), "{message}");
    assert!(start.elapsed() < Duration::from_secs(10));

    // A server that never ends its first line.
    let dripping = std::thread::spawn(move || {
        for _ in 0..3 {
            let Ok((mut stream, _)) = silent.accept() else {
                return;
            };
            while stream.write_all(b"x").is_ok() {}
        }
    });
    let (code, message) = probe(&["--url", &url, "--timeout", "20"]);
    assert_eq!(code, Some(1), "{message}");
    drop(dripping);

    let free = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = free.local_addr().expect("bound").to_string();
    drop(free);
    let (code, message) = probe(&["--url", &format!("http://{address}")]);
    assert_eq!(code, Some(1));
    assert!(message.contains(&address), "{message}");
}

#[test]
fn the_probe_speaks_tls() {
    let folder = tempfile::tempdir().expect("a folder");
    let authority = Authority::new();
    authority.issue_server().write_server(folder.path());
    let write = |name: &str, pem: String| {
        std::fs::write(folder.path().join(name), pem).expect("writable");
        folder.path().join(name).display().to_string()
    };
    let ca = write("ca.pem", authority.pem());
    let other = write("other.pem", Authority::new().pem());
    let daemon = Daemon::with_tls(folder.path(), &["shutdown.notice_seconds=20"]);
    let url = format!("https://{}", daemon.address());

    // The images' health check: settings from the environment, no flags for TLS.
    let health_check = || {
        let output = strew()
            .args(["probe", "--ready"])
            .env("STREW_SERVER_LISTEN", daemon.address().to_string())
            .env("STREW_TLS_CERTIFICATE", folder.path().join("server.pem"))
            .env("STREW_TLS_KEY", folder.path().join("server.key"))
            .output()
            .expect("the program runs");
        String::from_utf8(output.stderr).expect("UTF-8")
    };
    assert_eq!(health_check(), "");
    let yes = (Some(0), String::new());
    assert_eq!(probe(&["--url", &url, "--ca", &ca]), yes);
    assert_eq!(probe(&["--url", &url, "--live", "--insecure"]), yes);
    let named = format!("https://127.0.0.2:{}", daemon.address().port());
    for (arguments, code, part) in [
        // The certificate is not trusted, or not for that name.
        (
            &["--url", &url, "--ca", &other][..],
            1,
            "invalid peer certificate",
        ),
        (
            &["--url", &url, "--ca", &ca, "--server-name", "else.example"],
            1,
            "else.example",
        ),
        // Plain HTTP gets no answer from a TLS port.
        (
            &["--url", &daemon.url("")],
            1,
            "a daemon with TLS needs https",
        ),
        (&["--url", &named], 2, "https needs --ca FILE"),
    ] {
        let (ended, message) = probe(arguments);
        assert_eq!(ended, Some(code), "{arguments:?}: {message}");
        assert!(message.contains(part), "no `{part}`: {message}");
    }
    daemon.terminate();
    until("it is not ready", || {
        health_check().contains("not ready: status 503")
    });
}

#[test]
fn a_certificate_that_is_its_own_authority_is_believed_if_it_is_the_one_in_the_file() {
    for (year, expected) in [(4000, ""), (2020, "expired")] {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name).display().to_string();
        self_signed(year).write_server(folder.path());
        std::fs::write(path("other.pem"), self_signed(4000).pem).expect("writable");
        let daemon = Daemon::with_tls(folder.path(), &[]);
        let url = format!("https://{}", daemon.address());
        let ca = path("server.pem");
        let (code, message) = probe(&["--url", &url, "--ca", &ca]);
        let is_good = expected.is_empty();
        assert_eq!(code, Some(i32::from(!is_good)), "{message}");
        assert!(message.contains(expected), "{message}");
        for (flags, part) in [
            (
                &["--ca", &ca, "--server-name", "else.example"][..],
                "else.example",
            ),
            (&["--ca", &path("other.pem")], "invalid peer certificate"),
        ] {
            let (code, message) = probe(&[&["--url", &url], flags].concat());
            assert_eq!(code, Some(1), "{message}");
            assert!(message.contains(part), "{message}");
        }
    }
}

#[test]
fn the_probe_presents_a_client_certificate() {
    let folder = tempfile::tempdir().expect("a folder");
    let (servers, clients) = (Authority::new(), Authority::new());
    servers.issue_server().write_server(folder.path());
    let write = |name: &str, pem: &str| {
        std::fs::write(folder.path().join(name), pem).expect("writable");
        folder.path().join(name).display().to_string()
    };
    let ca = write("ca.pem", &servers.pem());
    write("clients.pem", &clients.pem());
    let known = clients.issue_client();
    let certificate = write("probe.pem", &known.pem);
    let key = write("probe.key", &known.key_pem);
    let daemon = Daemon::with_tls(folder.path(), &[]);
    let url = format!("https://{}", daemon.address());
    let shown = ["--url", &url, "--ca", &ca, "--certificate", &certificate];
    let with_key = [&shown[..], &["--key", &key]].concat();
    assert_eq!(probe(&with_key), (Some(0), String::new()));
    let (code, message) = probe(&["--url", &url, "--ca", &ca]);
    assert_eq!(code, Some(1));
    assert!(message.contains("use --certificate and --key"), "{message}");

    let server_key = folder.path().join("server.key").display().to_string();
    for (key, part) in [
        (&*server_key, "does not go with --certificate"),
        (&*certificate, "no private key"),
        ("/nowhere", "--key /nowhere: it cannot be read"),
    ] {
        let (code, message) = probe(&[&shown[..], &["--key", key]].concat());
        assert_eq!(code, Some(2));
        assert!(message.contains(part), "no `{part}`: {message}");
    }
}
