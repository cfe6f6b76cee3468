//! A small HTTP/1.1 client that takes every fault as an answer.

use std::{
    io::{self, BufRead as _, BufReader, Read, Write as _},
    net::{SocketAddr, TcpStream},
    time::Duration,
};

/// How long a reader waits for more.
const PATIENCE: Duration = Duration::from_secs(60);

/// The head of an answer; the body is read from it.
pub struct Opened {
    pub status: u16,
    headers: Vec<(String, String)>,
    stream: BufReader<TcpStream>,
    left: Left,
}

/// What is left of a body.
enum Left {
    Bytes(u64),
    /// Of this chunk; then come others.
    Chunk(u64),
    Nothing,
}

impl Opened {
    pub fn header(&self, name: &str) -> Option<&str> {
        let mut headers = self.headers.iter();
        headers.find_map(|(own, value)| (own == name).then_some(value.as_str()))
    }

    /// More of the body; nothing at its end. A body that breaks off is an error.
    pub fn more(&mut self, into: &mut [u8]) -> io::Result<usize> {
        loop {
            let room = match self.left {
                Left::Nothing => return Ok(0),
                Left::Bytes(0) => {
                    self.left = Left::Nothing;
                    return Ok(0);
                }
                Left::Chunk(0) => {
                    self.left = match chunk(&mut self.stream)? {
                        0 => Left::Nothing,
                        size => Left::Chunk(size),
                    };
                    continue;
                }
                Left::Bytes(left) | Left::Chunk(left) => left.min(into.len() as u64),
            };
            let read = self.stream.read(&mut into[..room as usize])?;
            if read == 0 {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            match &mut self.left {
                Left::Bytes(left) => *left -= read as u64,
                Left::Chunk(left) => {
                    *left -= read as u64;
                    if *left == 0 {
                        line(&mut self.stream)?;
                    }
                }
                Left::Nothing => {}
            }
            return Ok(read);
        }
    }

    /// The whole body, as it was before it was compressed.
    pub fn whole(mut self) -> io::Result<Vec<u8>> {
        let (mut body, mut part) = (vec![], vec![0; 1 << 16]);
        loop {
            match self.more(&mut part)? {
                0 => break,
                read => body.extend_from_slice(&part[..read]),
            }
        }
        match self.header("content-encoding") {
            Some("zstd") => zstd::decode_all(&*body),
            Some("gzip") => {
                let mut plain = vec![];
                flate2::read::MultiGzDecoder::new(&*body).read_to_end(&mut plain)?;
                Ok(plain)
            }
            _ => Ok(body),
        }
    }
}

fn line(stream: &mut BufReader<TcpStream>) -> io::Result<String> {
    let mut line = String::new();
    if stream.read_line(&mut line)? == 0 {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(line.trim_end().to_owned())
}

fn chunk(stream: &mut BufReader<TcpStream>) -> io::Result<u64> {
    let size = line(stream)?;
    let size = u64::from_str_radix(&size, 16).map_err(|_| io::ErrorKind::InvalidData)?;
    if size == 0 {
        line(stream)?;
    }
    Ok(size)
}

/// A connection.
pub fn connect(address: SocketAddr) -> io::Result<TcpStream> {
    let stream = TcpStream::connect_timeout(&address, Duration::from_secs(5))?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.set_nodelay(true)?;
    Ok(stream)
}

/// Asks, and reads the answer's head. A body makes it a POST.
pub fn ask(
    address: SocketAddr,
    path: &str,
    headers: &[(&str, &str)],
    body: Option<&[u8]>,
) -> io::Result<Opened> {
    let mut stream = connect(address)?;
    let method = if body.is_some() { "POST" } else { "GET" };
    let mut request =
        format!("{method} {path} HTTP/1.1\r\nhost: {address}\r\nconnection: close\r\n");
    for (name, value) in headers {
        request += &format!("{name}: {value}\r\n");
    }
    if let Some(body) = body {
        request += &format!("content-length: {}\r\n", body.len());
    }
    request += "\r\n";
    let mut request = request.into_bytes();
    request.extend_from_slice(body.unwrap_or_default());
    stream.write_all(&request)?;
    let mut stream = BufReader::with_capacity(1 << 16, stream);
    let status = line(&mut stream)?;
    let status = status.split(' ').nth(1).and_then(|text| text.parse().ok());
    let status = status.ok_or(io::ErrorKind::InvalidData)?;
    let mut headers = vec![];
    loop {
        let line = line(&mut stream)?;
        match line.split_once(':') {
            Some((name, value)) => headers.push((name.to_ascii_lowercase(), value.trim().into())),
            None => break,
        }
    }
    let find = |name: &str| headers.iter().find(|(own, _)| own == name).map(|(_, v)| v);
    let left = if find("transfer-encoding").is_some() {
        Left::Chunk(0)
    } else {
        let length = find("content-length").and_then(|text: &String| text.parse().ok());
        length.map_or(Left::Nothing, Left::Bytes)
    };
    Ok(Opened {
        status,
        headers,
        stream,
        left,
    })
}
