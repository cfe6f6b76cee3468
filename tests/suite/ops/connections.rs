//! Connections: their number is bounded, silent and stalled ones are closed, and all are freed.

use std::{
    io::Write as _,
    net::TcpStream,
    time::{Duration, Instant},
};

use strew_testkit::{
    http1::{self, read_to_close},
    wait::{PATIENCE, until},
};

use crate::support::{daemon::Daemon, queries::long};

fn connect(daemon: &Daemon) -> TcpStream {
    http1::connect(daemon.address()).expect("connected")
}

/// Whether a request over a new connection is answered.
fn is_served(daemon: &Daemon) -> bool {
    let mut stream = connect(daemon);
    let request = b"GET /livez HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n\r\n";
    stream.write_all(request).is_ok() && read_to_close(stream).starts_with("HTTP/1.1 200")
}

#[test]
fn one_connection_too_many_gets_a_problem_and_the_others_go_on() {
    let daemon = Daemon::start(&["server.max_connections=3"]);
    let mut reader = http1::open(daemon.address(), "GET", &long("f32"), &[]);
    let idle = [connect(&daemon), connect(&daemon)];
    // The system may accept a connection before the daemon counts it.
    let refusal = until("no connection is left", || {
        let mut stream = connect(&daemon);
        let request = b"GET /livez HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n\r\n";
        let _ = stream.write_all(request);
        let response = read_to_close(stream);
        (!response.starts_with("HTTP/1.1 200")).then_some(response)
    });
    assert!(refusal.starts_with("HTTP/1.1 503 "), "{refusal}");
    for words in [
        "retry-after: 1",
        "application/problem+json",
        "urn:strew:problem:busy",
        "\"limit\":3",
    ] {
        assert!(refusal.contains(words), "no `{words}`: {refusal}");
    }
    assert!(reader.skip(1 << 20).expect("more") > 0, "it goes on");
    drop(idle);
    until("a connection is free", || is_served(&daemon));
}

#[test]
fn silent_and_incomplete_connections_are_closed() {
    let daemon = Daemon::start(&[
        "server.header_read_timeout_seconds=0.3",
        "server.max_connections=8",
    ]);
    // Nothing; a byte; the beginning of HTTP/2; an incomplete head; a request without another one.
    let beginnings: [&[u8]; 5] = [
        b"",
        b"P",
        b"PRI * HTTP/2.0\r\n",
        b"GET /livez HTTP/1.1\r\nhost: localhost\r\n",
        b"GET /livez HTTP/1.1\r\nhost: localhost\r\n\r\n",
    ];
    let streams = beginnings.map(|beginning| {
        let mut stream = connect(&daemon);
        stream.write_all(beginning).expect("sent");
        stream
    });
    let start = Instant::now();
    for (stream, beginning) in streams.into_iter().zip(beginnings) {
        read_to_close(stream);
        let waited = start.elapsed();
        assert!(waited < PATIENCE / 2, "{waited:?} for {beginning:?}");
    }
    assert!(is_served(&daemon));
}

#[test]
fn a_reader_that_takes_nothing_loses_its_connection() {
    let daemon = Daemon::start(&["server.stalled_reader_seconds=0.5"]);
    let before = daemon.open_files();
    let stuck = http1::open(daemon.address(), "GET", &long("f32"), &[]);
    let mut slow = http1::open(daemon.address(), "GET", &long("f32"), &[]);
    assert_eq!((stuck.status, slow.status), (200, 200));
    // A reader that keeps taking a little stays.
    let start = Instant::now();
    until("the stalled stream is freed", || {
        assert!(slow.skip(1 << 20).expect("it goes on") > 0);
        daemon.streams() == 1
    });
    assert!(start.elapsed() >= Duration::from_millis(300));
    // Its socket is closed, too, although unsent data remain.
    until("its connection is closed", || {
        assert!(slow.skip(1 << 20).expect("it goes on") > 0);
        daemon.open_files() <= before + 1
    });
    assert!(!stuck.drain(), "the answer looks complete");
    assert!(slow.skip(1 << 20).expect("it goes on") > 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn an_idle_http2_connection_ends_with_goaway() {
    let daemon = Daemon::start(&["server.idle_connection_seconds=0.3"]);
    let stream = tokio::net::TcpStream::connect(daemon.address()).await;
    let (mut client, connection) = h2::client::handshake(stream.expect("connected"))
        .await
        .expect("HTTP/2");
    let ended = tokio::spawn(connection);
    let ask = http::Request::get(daemon.url("/livez"))
        .body(())
        .expect("valid");
    let (answer, _) = client.send_request(ask, true).expect("sent");
    assert_eq!(answer.await.expect("an answer").status(), 200);
    let ended = tokio::time::timeout(PATIENCE, ended).await;
    // The connection ends with GOAWAY without an error.
    ended
        .expect("it ends")
        .expect("no panic")
        .expect("no error");
}
