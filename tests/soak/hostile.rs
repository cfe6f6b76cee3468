//! Clients as nobody wants them. What they hear does not matter; that others are served does.

use std::{
    io::{Read as _, Write as _},
    net::{Shutdown, SocketAddr},
    time::Duration,
};

use crate::{any::Dice, http, tally::Done};

/// One whose answer is long.
const LONG: &str = "/v1/points?bbox=0,0,30000,30000&spacing=1&format=";

/// Reads a little of much and goes, in good order or not.
pub fn vanish(at: SocketAddr, dice: &mut Dice) -> Done {
    let format = ["f32", "f64", "csv", "ndjson", "arrow", "json"][dice.below(6) as usize];
    let mut stream = http::connect(at)?;
    write!(stream, "GET {LONG}{format} HTTP/1.1\r\nhost: x\r\n\r\n")?;
    let mut part = vec![0; 1 + dice.below(1 << 18) as usize];
    for _ in 0..dice.below(4) {
        let _ = stream.read(&mut part)?;
    }
    if dice.once_in(2) {
        // Without a goodbye: what is on its way is answered by a reset.
        let _ = socket2::SockRef::from(&stream).set_linger(Some(Duration::ZERO));
    }
    Ok(0)
}

/// Begins and says no more, then goes.
pub fn half(at: SocketAddr, dice: &mut Dice) -> Done {
    let request =
        b"POST /v1/points:query HTTP/1.1\r\nhost: x\r\ncontent-length: 1000\r\n\r\n{\"region\":";
    let mut stream = http::connect(at)?;
    stream.write_all(&request[..dice.below(request.len() as u64) as usize])?;
    if dice.once_in(2) {
        let _ = stream.shutdown(Shutdown::Write);
    }
    std::thread::park_timeout(Duration::from_millis(dice.below(30)));
    Ok(0)
}

/// Speaks something else.
pub fn garbage(at: SocketAddr, dice: &mut Dice) -> Done {
    let mut stream = http::connect(at)?;
    let mut bytes = match dice.below(4) {
        0 => b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n".to_vec(),
        1 => b"GET / HTTP/1.1\r\nhost: x\r\ntransfer-encoding: chunked\r\n\r\n".to_vec(),
        2 => b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03".to_vec(),
        _ => vec![],
    };
    bytes.extend((0..dice.below(2000)).map(|_| dice.below(256) as u8));
    // It may be cut short, which is right.
    let _ = stream.write_all(&bytes);
    let _ = stream.shutdown(Shutdown::Write);
    let mut part = [0; 1 << 12];
    let _ = stream.set_read_timeout(Some(Duration::from_millis(200)));
    let _ = stream.read(&mut part);
    Ok(0)
}
