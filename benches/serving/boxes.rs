//! Small boxes, each in another place, next to constant answers of the same size: one that the daemon sends, and one of
//! the HTTP library alone, the floor.

use std::{
    net::SocketAddr,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _},
    net::TcpStream,
};

use super::{
    host::{Host, SMALL},
    timing::{Effort, median},
};

/// A connection that is used for many requests.
struct Connection {
    socket: TcpStream,
    buffer: Vec<u8>,
}

impl Connection {
    /// Requests a path and reads the answer.
    async fn get(&mut self, path: &str) {
        let head = format!("GET {path} HTTP/1.1\r\nhost: localhost\r\n\r\n");
        self.socket.write_all(head.as_bytes()).await.expect("sent");
        let mut read = 0;
        let end = loop {
            read += self.read(read).await;
            if let Some(at) = self.buffer[..read]
                .windows(4)
                .position(|w| w == b"\r\n\r\n")
            {
                break at + 4;
            }
        };
        let head = String::from_utf8_lossy(&self.buffer[..end]).to_ascii_lowercase();
        assert!(head.starts_with("http/1.1 200"), "{head}");
        let length = head.split("content-length: ").nth(1).expect("a length");
        let length: usize = length
            .split("\r\n")
            .next()
            .and_then(|digits| digits.parse().ok())
            .expect("a number");
        while read < end + length {
            read += self.read(read).await;
        }
    }

    async fn read(&mut self, from: usize) -> usize {
        let room = &mut self.buffer[from..];
        let read = self.socket.read(room).await.expect("readable");
        assert!(read > 0, "the server hung up");
        read
    }
}

/// What one burst measured.
struct Burst {
    /// Answers per second.
    rate: f64,
    /// The 99th percentile of their times, in seconds.
    p99: f64,
}

/// Sends requests over several connections at once for `time`.
async fn burst(
    address: SocketAddr,
    connections: usize,
    time: Duration,
    path: impl Fn(u64) -> String + Clone + Send + 'static,
) -> Burst {
    let number = Arc::new(AtomicU64::new(0));
    let start = Instant::now();
    let tasks: Vec<_> = (0..connections)
        .map(|_| {
            let (number, path) = (number.clone(), path.clone());
            tokio::spawn(async move {
                let socket = TcpStream::connect(address).await.expect("a listener");
                socket.set_nodelay(true).expect("a socket");
                let buffer = vec![0; 64 << 10];
                let mut connection = Connection { socket, buffer };
                let mut times = vec![];
                // At least one answer each, however busy the machine.
                loop {
                    let sent = Instant::now();
                    let path = path(number.fetch_add(1, Ordering::Relaxed));
                    connection.get(&path).await;
                    times.push(sent.elapsed().as_secs_f64());
                    if start.elapsed() >= time {
                        return times;
                    }
                }
            })
        })
        .collect();
    let mut times = vec![];
    for task in tasks {
        times.extend(task.await.expect("no panic"));
    }
    let rate = times.len() as f64 / start.elapsed().as_secs_f64();
    times.sort_by(f64::total_cmp);
    Burst {
        rate,
        p99: times[times.len() * 99 / 100],
    }
}

/// The path of a box of about 1,000 points, in another place for each number.
fn elsewhere(number: u64) -> String {
    let (x, y) = ((number % 997) * 40, (number / 997) * 40);
    let (to_x, to_y) = (x as f64 + 31.6, y as f64 + 31.6);
    format!("/v1/points?bbox={x},{y},{to_x},{to_y}&spacing=1&format=f32")
}

/// Answers per second on 1, 16 and 64 connections.
pub fn boxes(host: &Host, effort: Effort) {
    let time = Duration::from_millis(if effort.quick { 30 } else { 600 });
    let client = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .expect("a runtime");
    println!("\nBoxes of 1,000 points as f32 (8 kB), HTTP/1.1, each in another place");
    println!(
        "{:<12} {:>10} {:>10} {:>6} {:>10} {:>6} {:>8} {:>8} {:>6} {:>8} {:>6}",
        "connections",
        "boxes/s",
        "constant/s",
        "ratio",
        "alone/s",
        "ratio",
        "p99 µs",
        "const.",
        "ratio",
        "alone",
        "ratio"
    );
    for connections in [1, 16, 64] {
        let mut figures: [Vec<f64>; 6] = Default::default();
        for _ in 0..effort.rounds {
            let made = client.block_on(burst(host.address, connections, time, elsewhere));
            let path = |_| format!("/bench/small/{SMALL}");
            let constant = client.block_on(burst(host.address, connections, time, path));
            let alone = client.block_on(burst(host.alone, connections, time, path));
            let bursts = [made, constant, alone];
            let all = bursts.iter().flat_map(|burst| [burst.rate, burst.p99]);
            for (figure, list) in all.zip(&mut figures) {
                list.push(figure);
            }
        }
        let [made, p99, constant, constant_p99, alone, alone_p99] = figures.map(median);
        println!(
            "{connections:<12} {made:>10.0} {constant:>10.0} {:>6.2} {alone:>10.0} {:>6.2} {:>8.0} {:>8.0} {:>6.2} \
             {:>8.0} {:>6.2}",
            made / constant,
            made / alone,
            p99 * 1e6,
            constant_p99 * 1e6,
            p99 / constant_p99,
            alone_p99 * 1e6,
            p99 / alone_p99
        );
    }
}
