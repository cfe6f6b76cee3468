//! Clients at an address of their own that take as much as they can, in small: unread pages and
//! answers, large bodies, long counts, slow readers, unfinished calls. Their answers do not matter.

use std::{
    io::{self, Read as _, Write as _},
    net::SocketAddr,
    time::Duration,
};

use strew_testkit::random::SplitMix;

use crate::{
    attack::{self, without_window},
    tally::Done,
};

/// Megabytes of answer to some bytes of request.
const LARGE: &str = "/v1/nearest?at=0,0&k=10000&spacing=1&attributes=angle,u1,u2,u3,u4,u5,u6,u7,u8";
/// Seconds of counting.
const COUNT: &str = "/v1/count?circle=0,0,270000&spacing=1&warp=2&seed=7";
/// Minutes of points.
const LONG: &str = "/v1/points?bbox=0,0,30000,30000&spacing=1&format=f32";

/// One attack of any kind, for a second at most.
pub async fn any(at: SocketAddr, random: &mut SplitMix) -> Done {
    let time = Duration::from_millis(100 + random.below(900));
    // The daemon may refuse or hang up at any point, as it should.
    let _ = match random.below(7) {
        0 => unread_streams(at, "/openapi.json", time).await,
        1 => unread_streams(at, "/v1/profiles/blue/spectrum.svg", time).await,
        2 => unread(at, LARGE, 8, time),
        3 => refused_body(at),
        4 => unread(at, COUNT, 2, time),
        5 => slow_reader(at, time),
        _ => unfinished_calls(at, time).await,
    };
    Ok(0)
}

/// Streams of one connection whose answers have no window.
async fn unread_streams(at: SocketAddr, path: &str, time: Duration) -> io::Result<()> {
    let (client, _) = without_window(at).await?;
    let mut client = client.ready().await.map_err(io::Error::other)?;
    let mut answers = vec![];
    for coding in ["zstd", "gzip", "identity"].into_iter().cycle().take(99) {
        let request = http::Request::get(format!("http://{at}{path}"))
            .header("accept-encoding", coding)
            .body(())
            .expect("valid");
        let (answer, _) = client
            .send_request(request, true)
            .map_err(io::Error::other)?;
        answers.push(answer);
        client = client.ready().await.map_err(io::Error::other)?;
    }
    tokio::time::sleep(time).await;
    Ok(())
}

/// Connections that send a request each and read nothing.
fn unread(at: SocketAddr, path: &str, connections: usize, time: Duration) -> io::Result<()> {
    let all: io::Result<Vec<_>> = (0..connections)
        .map(|_| attack::get(at, path, ""))
        .collect();
    std::thread::park_timeout(time);
    all.map(drop)
}

/// A body that is as large as it may be and wrong from its beginning.
fn refused_body(at: SocketAddr) -> io::Result<()> {
    let body = format!("{{\"unknown\": [0{}]}}", ",0".repeat(2_000_000));
    let mut stream = attack::connect(at)?;
    let head = format!(
        "POST /v1/points:query HTTP/1.1\r\nhost: localhost\r\ncontent-length: {}\r\n\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body.as_bytes())?;
    stream.read(&mut [0; 100]).map(drop)
}

/// Some bytes of a long stream, one now and then.
fn slow_reader(at: SocketAddr, time: Duration) -> io::Result<()> {
    let mut stream = attack::get(at, LONG, "")?;
    for _ in 0..10 {
        stream.read_exact(&mut [0])?;
        std::thread::park_timeout(time / 10);
    }
    Ok(())
}

/// Health checks whose messages never come, and watches.
async fn unfinished_calls(at: SocketAddr, time: Duration) -> io::Result<()> {
    let (client, _) = without_window(at).await?;
    let mut client = client.ready().await.map_err(io::Error::other)?;
    let mut calls = vec![];
    for method in ["Check", "Watch"].into_iter().cycle().take(60) {
        let request = http::Request::post(format!("http://{at}/grpc.health.v1.Health/{method}"))
            .header("content-type", "application/grpc")
            .body(())
            .expect("valid");
        let call = client.send_request(request, false);
        let (answer, mut sent) = call.map_err(io::Error::other)?;
        if method == "Watch" {
            let empty = bytes::Bytes::from_static(&[0; 5]);
            sent.send_data(empty, true).map_err(io::Error::other)?;
        }
        calls.push((answer, sent));
        client = client.ready().await.map_err(io::Error::other)?;
    }
    tokio::time::sleep(time).await;
    Ok(())
}
