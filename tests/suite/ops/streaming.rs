//! Long streams: memory does not grow with their length, and they end with their readers.

use std::time::{Duration, Instant};

use strew::grpc::proto::{Encoding, StreamPointsRequest, point_service_client::PointServiceClient};
use strew_testkit::{
    http1,
    wait::{PATIENCE, until},
};

use crate::support::{
    daemon::Daemon,
    grpc::{LONG, square},
    queries::long,
};

/// The most memory that the daemon may hold, in KiB.
const MOST_MEMORY: u64 = 100 << 10;

#[test]
fn a_billion_points_to_slow_readers_take_little_memory() {
    let daemon = Daemon::start(&[]);
    let mut readers: Vec<_> = ["f32", "f64", "ndjson", "f32"]
        .iter()
        .map(|format| {
            let opened = http1::open(daemon.address(), "GET", &long(format), &[]);
            assert_eq!(opened.status, 200);
            let count: u64 = opened.headers["strew-count"].parse().expect("a number");
            assert!(count > 1_000_000_000);
            opened
        })
        .collect();
    let start = Instant::now();
    let mut read = 0;
    while start.elapsed() < Duration::from_secs(3) {
        for reader in &mut readers {
            read += reader.skip(64 << 10).expect("more");
        }
        let resident = daemon.memory_kib("VmRSS");
        assert!(resident < MOST_MEMORY, "{resident} KiB");
        std::thread::park_timeout(Duration::from_millis(10));
    }
    assert!(read > 1 << 20, "something was read");
    // Then one reader as fast as it can.
    let mut left = 100 << 20;
    while left > 0 {
        left -= readers[0].skip(1 << 20).expect("more").min(left);
    }
    let peak = daemon.memory_kib("VmHWM");
    assert!(peak < MOST_MEMORY, "{peak} KiB");
    assert_eq!(daemon.streams(), 4);
}

#[test]
fn vanished_clients_leave_nothing_running() {
    let daemon = Daemon::start(&[
        "per_address.max_streams=100",
        "per_address.max_bytes_in_flight=1000000000",
    ]);
    let mut readers: Vec<_> = (0..100)
        .map(|i| {
            let format = ["f32", "json", "csv", "f64"][i % 4];
            http1::open(daemon.address(), "GET", &long(format), &[])
        })
        .collect();
    for reader in &mut readers {
        assert!(reader.skip(4096).expect("bytes") > 0);
    }
    assert_eq!(daemon.streams(), 100);
    drop(readers);
    daemon.until_no_streams();
    idle(&daemon);
    assert_eq!(daemon.get("/livez").status, 200);
}

/// Waits until the daemon uses next to no processor time.
fn idle(daemon: &Daemon) {
    until("the daemon is idle", || {
        let ticks = daemon.cpu_ticks_over(Duration::from_millis(300));
        ticks <= 1
    });
}

#[tokio::test(flavor = "multi_thread")]
async fn grpc_streams_end_with_their_readers_too() {
    let daemon = Daemon::start(&[]);
    let channel = daemon.channel().await;
    let mut streams = vec![];
    for encoding in [Encoding::Points, Encoding::F64Le, Encoding::F32Le] {
        let mut client = PointServiceClient::new(channel.clone());
        let request = StreamPointsRequest {
            encoding: encoding.into(),
            ..square(LONG)
        };
        let answer = client.stream_points(request).await.expect("an answer");
        let mut stream = answer.into_inner();
        // Clients decode 4 MiB at most by default; blocks stay well below.
        for _ in 0..20 {
            let message = stream.message().await.expect("a message").expect("more");
            assert!(prost::Message::encoded_len(&message) <= 1 << 20);
        }
        streams.push(stream);
    }
    assert_eq!(daemon.streams(), 3);
    let resident = daemon.memory_kib("VmRSS");
    assert!(resident < MOST_MEMORY, "{resident} KiB");
    drop(streams);
    let daemon = tokio::task::spawn_blocking(move || {
        daemon.until_no_streams();
        idle(&daemon);
        daemon
    });
    let daemon = tokio::time::timeout(PATIENCE, daemon).await;
    daemon.expect("in time").expect("no panic");
}

#[test]
fn a_fast_reader_gets_everything() {
    let daemon = Daemon::start(&[]);
    let path = "/v1/points?bbox=-600,-600,600,600&density=1&profile=test&format=";
    let packed = daemon.get(&format!("{path}f32"));
    let count: usize = packed.header("strew-count").parse().expect("a number");
    assert_eq!(packed.body.len(), 8 * count);
    let opened = http1::open(daemon.address(), "GET", &format!("{path}ndjson"), &[]);
    let (body, complete) = opened.finish();
    assert!(complete);
    let lines = body.iter().filter(|&&byte| byte == b'\n').count();
    assert_eq!(lines, count + 1);
    daemon.until_no_streams();
}
