//! Clients that misbehave. Their answers do not matter; other clients must still be served.

use std::{
    io::{Read as _, Write as _},
    net::{Shutdown, SocketAddr},
    time::Duration,
};

use strew_testkit::{http1, random::SplitMix};

use crate::tally::Done;

/// A path with a long answer, without its format.
const LONG: &str = "/v1/points?bbox=0,0,30000,30000&spacing=1&format=";

/// Reads a little of a long answer and hangs up, by a close or by a reset.
pub fn vanish(at: SocketAddr, random: &mut SplitMix) -> Done {
    let format = ["f32", "f64", "csv", "ndjson", "arrow", "json"][random.index(6)];
    let mut stream = http1::connect(at)?;
    write!(
        stream,
        "GET {LONG}{format} HTTP/1.1\r\nhost: localhost\r\n\r\n"
    )?;
    let mut part = vec![0; 1 + random.index(1 << 18)];
    for _ in 0..random.below(4) {
        let _ = stream.read(&mut part)?;
    }
    if random.once_in(2) {
        // Closing without lingering sends a reset.
        let _ = socket2::SockRef::from(&stream).set_linger(Some(Duration::ZERO));
    }
    Ok(0)
}

/// Sends a part of a request and hangs up.
pub fn half(at: SocketAddr, random: &mut SplitMix) -> Done {
    let request =
        b"POST /v1/points:query HTTP/1.1\r\nhost: localhost\r\ncontent-length: 1000\r\n\r\n{\"region\":";
    let mut stream = http1::connect(at)?;
    stream.write_all(&request[..random.index(request.len())])?;
    if random.once_in(2) {
        let _ = stream.shutdown(Shutdown::Write);
    }
    std::thread::park_timeout(Duration::from_millis(random.below(30)));
    Ok(0)
}

/// Sends bytes that are not HTTP.
pub fn garbage(at: SocketAddr, random: &mut SplitMix) -> Done {
    let mut stream = http1::connect(at)?;
    let mut bytes = match random.below(4) {
        0 => b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n".to_vec(),
        1 => b"GET / HTTP/1.1\r\nhost: localhost\r\ntransfer-encoding: chunked\r\n\r\n".to_vec(),
        2 => b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03".to_vec(),
        _ => vec![],
    };
    bytes.extend((0..random.below(2000)).map(|_| random.bits() as u8));
    // The daemon may hang up at any point, as it should.
    let _ = stream.write_all(&bytes);
    let _ = stream.shutdown(Shutdown::Write);
    let mut part = [0; 1 << 12];
    let _ = stream.set_read_timeout(Some(Duration::from_millis(200)));
    let _ = stream.read(&mut part);
    Ok(0)
}
