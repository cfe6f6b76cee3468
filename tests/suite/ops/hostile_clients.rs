//! Hostile clients: thousands of silent connections, streams reset as soon as they are opened,
//! readers that never read. Memory stays bounded, others are served, and everything is freed.

use std::{
    io::{Read as _, Write as _},
    net::TcpStream,
    time::{Duration, Instant},
};

use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use strew_testkit::{
    http1,
    wait::{PATIENCE, until},
};

use crate::support::{
    daemon::Daemon,
    queries::{MANY_ROWS, SLOW, long},
};

const SMALL: &str = "/v1/points?bbox=0,0,9,9&density=1&profile=test";

/// The number of connections that this process may open, up to ten thousand.
fn most_connections() -> usize {
    /// Open files left to other tests.
    const OTHERS: u64 = 1500;
    let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
    let wanted = 10_000 + OTHERS;
    let possible = maximum.map_or(wanted, |most| most.min(wanted));
    if current.is_some_and(|now| now < possible) {
        let raised = Rlimit {
            current: Some(possible),
            maximum,
        };
        setrlimit(Resource::Nofile, raised).expect("within the hard limit");
    }
    let most = current.map_or(wanted, |now| now.max(possible));
    usize::try_from(most.saturating_sub(OTHERS))
        .expect("small")
        .min(10_000)
}

#[test]
fn ten_thousand_idle_connections_take_little_memory_and_others_are_served() {
    let count = most_connections();
    assert!(count >= 100, "this machine allows {count} connections");
    if count < 10_000 {
        println!("scaled to {count} connections by the limit on open files");
    }
    let limit = format!("server.max_connections={}", count + 10);
    let of_address = format!("per_address.max_connections={}", count + 10);
    let daemon = Daemon::start(&[
        &limit,
        &of_address,
        "server.header_read_timeout_seconds=3600",
    ]);
    assert_eq!(daemon.get(SMALL).status, 200);
    let before = daemon.memory_kib("VmRSS");
    // Silent ones, some with a part of a request, and some that have been answered.
    let words: [&[u8]; 4] = [
        b"",
        b"",
        b"GET /livez HTTP/1.1\r\nhost",
        b"GET /livez HTTP/1.1\r\nhost: localhost\r\n\r\n",
    ];
    let idle: Vec<TcpStream> = (0..count)
        .map(|i| {
            let mut stream = TcpStream::connect(daemon.address()).expect("connected");
            stream.write_all(words[i % words.len()]).expect("sent");
            stream
        })
        .collect();
    until("all are open", || daemon.open_files() > count);
    let grown = daemon.memory_kib("VmRSS") - before;
    println!("{count} idle connections: {grown} KiB");
    assert!(grown < 24 * count as u64, "{grown} KiB for {count}");
    let start = Instant::now();
    for _ in 0..20 {
        assert_eq!(daemon.get(SMALL).status, 200);
    }
    assert!(start.elapsed() < PATIENCE / 3);
    drop(idle);
    until("all are closed", || daemon.open_files() < 100);
    assert_eq!(daemon.get(SMALL).status, 200);
}

/// Connections that send bodies of 1 MB without the last `missing` bytes, each as fast as it can.
fn bodies(daemon: &Daemon, connections: usize, missing: usize) -> Vec<TcpStream> {
    let body = vec![b' '; 1_000_000 - missing];
    let head = "POST /v1/count HTTP/1.1\r\nhost: localhost\r\ncontent-length: 1000000\r\n\r\n";
    let send = |_| {
        let mut stream = TcpStream::connect(daemon.address()).expect("connected");
        stream.write_all(head.as_bytes()).expect("sent");
        stream.write_all(&body).expect("sent");
        stream
    };
    (0..connections).map(send).collect()
}

#[test]
fn bodies_take_their_length_and_leave_nothing_to_their_connections() {
    let daemon = Daemon::start(&[]);
    let answered = || {
        let mut stream = bodies(&daemon, 1, 0).remove(0);
        let mut head = [0; 12];
        stream.read_exact(&mut head).expect("a status");
        assert_eq!(&head[9..], b"400");
        stream
    };
    // The first connections load parts of the program that stay in memory.
    let mut open: Vec<_> = (0..10).map(|_| answered()).collect();
    let before = daemon.memory_kib("VmRSS");
    open.extend((0..100).map(|_| answered()));
    let grown = daemon.memory_kib("VmRSS").saturating_sub(before);
    println!("100 connections that sent 1 MB: {grown} KiB");
    assert!(grown < 100 * 128, "{grown} KiB");
    let waiting = bodies(&daemon, 50, 1);
    until("all have come", || {
        daemon.cpu_ticks_over(Duration::from_millis(100)) == 0
    });
    let peak = daemon.memory_kib("VmHWM").saturating_sub(before);
    println!("50 bodies of 1 MB that wait: {peak} KiB at most");
    assert!(peak < 75_000 + 100 * 128, "{peak} KiB");
    drop((open, waiting));
}

#[test]
fn silent_connections_are_closed_to_make_room() {
    let daemon = Daemon::start(&[
        "server.max_connections=200",
        "server.header_read_timeout_seconds=0.5",
    ]);
    let connect = || TcpStream::connect(daemon.address()).expect("connected");
    let idle: Vec<TcpStream> = (0..200).map(|_| connect()).collect();
    // They are still open on our side, yet there is room.
    until("there is room", || {
        let mut stream = connect();
        let request = b"GET /livez HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n\r\n";
        stream.write_all(request).ok()?;
        let mut response = String::new();
        std::io::Read::read_to_string(&mut stream, &mut response).ok()?;
        response.starts_with("HTTP/1.1 200").then_some(())
    });
    drop(idle);
}

#[test]
fn readers_that_never_read_take_little_memory_and_others_are_served() {
    let daemon = Daemon::start(&[
        "limits.max_streams=200",
        "per_address.max_streams=200",
        "per_address.max_bytes_in_flight=1000000000",
    ]);
    assert_eq!(daemon.get(SMALL).status, 200);
    let before = daemon.memory_kib("VmRSS");
    let stuck: Vec<_> = (0..200)
        .map(|i| {
            let path = long(["f32", "f64", "csv", "json"][i % 4]);
            let opened = http1::open(daemon.address(), "GET", &path, &[]);
            assert_eq!(opened.status, 200);
            opened
        })
        .collect();
    assert_eq!(daemon.streams(), 200);
    let grown = daemon.memory_kib("VmRSS").saturating_sub(before);
    println!("200 readers that never read: {grown} KiB");
    assert!(grown < 200 * 2048, "{grown} KiB");
    let count = "/v1/count?bbox=0,0,9,9&density=1&profile=test";
    assert_eq!(daemon.get(count).status, 200);
    drop(stuck);
    daemon.until_no_streams();
}

/// Sends up to `most` requests over a connection and resets each at once. Returns how many were
/// sent before the daemon closed the connection.
async fn reset_rapidly(daemon: &Daemon, most: usize) -> usize {
    let stream = tokio::net::TcpStream::connect(daemon.address()).await;
    let handshake = h2::client::handshake(stream.expect("connected")).await;
    let Ok((client, connection)) = handshake else {
        return 0;
    };
    let ended = tokio::spawn(connection);
    let mut client = client;
    for sent in 0..most {
        let Ok(ready) = client.ready().await else {
            return sent;
        };
        client = ready;
        let request = http::Request::post(daemon.url("/v1/count"))
            .body(())
            .expect("valid");
        let Ok((_answer, mut body)) = client.send_request(request, false) else {
            return sent;
        };
        let query = bytes::Bytes::from_static(SLOW.as_bytes());
        if body.send_data(query, true).is_err() {
            return sent;
        }
        // Let the daemon begin to count for some of them.
        if sent % 7 == 0 {
            tokio::task::yield_now().await;
        }
        body.send_reset(h2::Reason::CANCEL);
    }
    drop(client);
    ended.abort();
    most
}

#[tokio::test(flavor = "multi_thread")]
async fn rapid_resets_cost_little_and_leave_nothing() {
    const EACH: usize = 500;
    let daemon = Daemon::start(&[MANY_ROWS, "server.first_byte_seconds=3600"]);
    assert_eq!(daemon.get(SMALL).status, 200);
    let before = daemon.memory_kib("VmRSS");
    let mut sent = 0;
    for _ in 0..40 {
        sent += reset_rapidly(&daemon, EACH).await;
        assert_eq!(daemon.get(SMALL).status, 200, "others are served");
    }
    let grown = daemon.memory_kib("VmHWM").saturating_sub(before);
    println!("{sent} requests reset: {grown} KiB at most");
    assert!(sent > 0);
    // A request that was reset stays in the queue of the workers, a few KiB each, until one drops
    // it.
    assert!(grown < 200 << 10, "{grown} KiB");
    // The daemon stops computing for them.
    until("the daemon is idle", || {
        let ticks = daemon.cpu_ticks_over(Duration::from_millis(300));
        ticks <= 2
    });
    until("no connection is left", || daemon.open_files() < 100);
}

#[test]
fn a_log_that_cannot_be_written_stops_nothing() {
    let full = std::fs::File::options().write(true).open("/dev/full");
    let full = full.expect("Linux");
    let daemon = Daemon::logging_to(full, &["log.filter=trace", "limits.max_streams=1"]);
    let path = long("f32");
    let _held = http1::open(daemon.address(), "GET", &path, &[]);
    for _ in 0..20 {
        assert_eq!(daemon.get("/livez").status, 200);
        assert_eq!(daemon.get(&path).status, 503);
    }
}
