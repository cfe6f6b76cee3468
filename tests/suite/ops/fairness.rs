//! The effect of an attack on clients of other addresses. It depends on the machine, so it is measured:
//!
//! ```sh
//! cargo test --release --test suite fairness -- --ignored --nocapture
//! ```

use std::{
    io::{Read as _, Write as _},
    sync::atomic::{AtomicBool, Ordering},
    thread,
    time::{Duration, Instant},
};

use strew_testkit::http1;

use crate::support::{attack, daemon::Daemon};

/// How long each latency is measured.
const TIME: Duration = Duration::from_secs(4);

/// The latencies of a path, one request after the other: the median, the 99th percentile, the longest,
/// in milliseconds.
fn latencies(daemon: &Daemon, path: &str) -> [f64; 3] {
    let start = Instant::now();
    let mut all = vec![];
    while start.elapsed() < TIME {
        let sent = Instant::now();
        let answer = http1::get(daemon.address(), path, &[]);
        assert_eq!(answer.status, 200, "{}", answer.text());
        all.push(sent.elapsed().as_secs_f64() * 1e3);
    }
    all.sort_by(f64::total_cmp);
    let at = |share: f64| all[((all.len() - 1) as f64 * share) as usize];
    [at(0.5), at(0.99), at(1.0)]
}

/// Prints the latencies of paths alone, and while `clients` send a request over and over.
fn compare(daemon: &Daemon, name: &str, clients: usize, request: &[u8], paths: &[&str]) {
    let alone: Vec<_> = paths.iter().map(|path| latencies(daemon, path)).collect();
    let is_over = AtomicBool::new(false);
    thread::scope(|scope| {
        for _ in 0..clients {
            scope.spawn(|| {
                while !is_over.load(Ordering::Relaxed) {
                    let Ok(mut stream) = attack::connect(daemon.address()) else {
                        continue;
                    };
                    let _ = stream.write_all(request);
                    let _ = stream.read(&mut [0; 1000]);
                }
            });
        }
        for (path, alone) in paths.iter().zip(alone) {
            let attacked = latencies(daemon, path);
            println!("{name}: {path}: p50, p99, max alone {alone:.3?}, attacked {attacked:.3?} ms");
        }
        is_over.store(true, Ordering::Relaxed);
    });
}

const SMALL: &str = "/v1/points?bbox=0,0,10,10&spacing=1&profile=test";

/// A request with a body of 4 MB that is refused.
fn large_body() -> Vec<u8> {
    let body = format!(
        r#"{{"spacing": 1, "unknown": [0{}]}}"#,
        ",0".repeat(2_000_000)
    );
    let head = format!(
        "POST /v1/points:query HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\ncontent-length: {}\r\n\r\n",
        body.len()
    );
    [head.as_bytes(), body.as_bytes()].concat()
}

#[test]
fn large_bodies_are_read_on_the_threads_for_long_work() {
    let daemon = Daemon::start(&[]);
    let ticks = || {
        let others = ["strew-worker", "tokio"];
        let others: u64 = others
            .map(|name| daemon.cpu_ticks_of_threads(name))
            .iter()
            .sum();
        [daemon.cpu_ticks(), others]
    };
    let [all, others] = ticks();
    for _ in 0..8 {
        let mut stream = attack::connect(daemon.address()).expect("connected");
        stream.write_all(&large_body()).expect("sent");
        let answer = http1::read_to_close(stream);
        assert_eq!(&answer[9..12], "400", "{answer}");
    }
    let [all, others] = [0, 1].map(|i| ticks()[i] - [all, others][i]);
    assert!(others < all / 2, "{others} of {all} ticks");
}

#[test]
#[ignore = "a measurement"]
fn large_bodies_that_are_refused() {
    let daemon = Daemon::start(&[]);
    let request = large_body();
    compare(&daemon, "8 large bodies", 8, &request, &[SMALL, "/livez"]);
}

#[test]
#[ignore = "a measurement"]
fn long_counts() {
    let daemon = Daemon::start(&[]);
    let path = "/v1/count?circle=0,0,270000&spacing=1&warp=2&seed=7&profile=test";
    let request = format!("GET {path} HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n\r\n");
    let victims = [
        SMALL,
        "/livez",
        "/v1/count?circle=0,0,3000&spacing=1&profile=test",
        "/v1/points?bbox=0,0,200,200&spacing=1&warp=1&profile=test&format=csv",
        "/v1/chunks/64/3/4?spacing=1&profile=test&format=f32",
    ];
    compare(&daemon, "4 long counts", 4, request.as_bytes(), &victims);
}
