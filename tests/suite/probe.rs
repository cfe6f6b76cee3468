//! `strew probe`: what health checks of containers run.

use std::{
    io::Write as _,
    net::TcpListener,
    time::{Duration, Instant},
};

use crate::daemon::{Daemon, strew, until};

/// The exit code and the message.
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
    // Without a URL it looks where the settings say.
    assert_eq!(probe(&["--listen", daemon.address()]).0, Some(0));
    daemon.terminate();
    let message = until("it is not ready", || {
        let (code, message) = probe(&["--url", &url, "--ready"]);
        (code == Some(1)).then_some(message)
    });
    assert!(message.contains("not ready: status 503"), "{message}");
    assert_eq!(probe(&["--url", &url, "--live"]).0, Some(0));
}

#[test]
fn what_is_no_daemon_is_told_within_the_time() {
    let silent = TcpListener::bind("127.0.0.1:0").expect("a port");
    let url = format!("http://{}", silent.local_addr().expect("bound"));
    let start = Instant::now();
    let (code, message) = probe(&["--url", &url, "--timeout", "0.2"]);
    assert_eq!(code, Some(1));
    assert!(message.contains("no answer within 200ms"), "{message}");
    assert!(start.elapsed() < Duration::from_secs(10));

    // One that never ends its first line.
    let dripping = std::thread::spawn(move || {
        for _ in 0..2 {
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
fn wrong_flags_are_told() {
    for (arguments, told) in [
        (&["--url", "https:/x"][..], "allowed: http://host:port"),
        (&["--timeout", "0"], "allowed: 0.001 to 3600"),
        (&["--timeout", "NaN"], "allowed: 0.001 to 3600"),
        (&["--listen", "127.0.0.1:0"], "name it with --url"),
        (&["--live", "--ready"], "cannot be used with"),
    ] {
        let (code, message) = probe(arguments);
        assert_eq!(code, Some(2), "{arguments:?}");
        assert!(message.contains(told), "{message}");
    }
}
