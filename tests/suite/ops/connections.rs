//! Connections: so many and no more, none that only sits there, and all given back.

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

/// Whether a request is answered over a connection of its own.
fn is_served(daemon: &Daemon) -> bool {
    let mut stream = connect(daemon);
    let request = b"GET /livez HTTP/1.1\r\nhost: x\r\nconnection: close\r\n\r\n";
    stream.write_all(request).is_ok() && read_to_close(stream).starts_with("HTTP/1.1 200")
}

#[test]
fn one_connection_too_many_is_refused_in_words_and_the_others_go_on() {
    let daemon = Daemon::start(&["server.max_connections=3"]);
    let mut reader = http1::open(daemon.address(), "GET", &long("f32"), &[]);
    let idle = [connect(&daemon), connect(&daemon)];
    // The system may know of a connection before the daemon does.
    let refusal = until("no place is left", || {
        let mut stream = connect(&daemon);
        let request = b"GET /livez HTTP/1.1\r\nhost: x\r\nconnection: close\r\n\r\n";
        let _ = stream.write_all(request);
        let said = read_to_close(stream);
        (!said.starts_with("HTTP/1.1 200")).then_some(said)
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
    until("a place is free", || is_served(&daemon).then_some(()));
}

#[test]
fn connections_that_say_nothing_or_too_little_end() {
    let daemon = Daemon::start(&[
        "server.header_read_timeout_seconds=0.3",
        "server.max_connections=8",
    ]);
    // Nothing; the beginning of HTTP/2 and no more; a head that never ends; a request and no second.
    let beginnings: [&[u8]; 5] = [
        b"",
        b"P",
        b"PRI * HTTP/2.0\r\n",
        b"GET /livez HTTP/1.1\r\nhost: x\r\n",
        b"GET /livez HTTP/1.1\r\nhost: x\r\n\r\n",
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
    // One that takes a little all the time stays.
    let start = Instant::now();
    until("the other's place is free", || {
        assert!(slow.skip(1 << 20).expect("it goes on") > 0);
        (daemon.streams() == 1).then_some(())
    });
    assert!(start.elapsed() >= Duration::from_millis(300));
    // Its socket is closed, too, although there is more to take than it will ever take.
    until("its connection is closed", || {
        assert!(slow.skip(1 << 20).expect("it goes on") > 0);
        (daemon.open_files() <= before + 1).then_some(())
    });
    assert!(!stuck.drain(), "it is visibly not complete");
    assert!(slow.skip(1 << 20).expect("it goes on") > 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn an_http2_connection_without_requests_ends_in_good_order() {
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
    // It said goodbye (GOAWAY without an error) rather than hang up.
    ended
        .expect("it ends")
        .expect("no panic")
        .expect("no error");
}
