//! One request by HTTP/1.1 and its answer, read as it comes.

use std::{
    fmt,
    io::{self, BufRead as _, BufReader, Read, Write},
    net::TcpStream,
};

use anyhow::{Context as _, bail};
use rustls::{ClientConnection, StreamOwned};

use super::shown::shown;
use crate::cli::probe::Trust;

/// The most bytes of the head of an answer.
const MOST_HEAD: u64 = 64 << 10;

/// What a connection is read and written by.
trait Stream: Read + Write {}
impl<T: Read + Write> Stream for T {}

/// An answer.
#[derive(Debug)]
pub(in crate::cli) struct Answer {
    pub(in crate::cli) status: u16,
    headers: Vec<(String, String)>,
    pub(in crate::cli) body: Body,
}

/// The body of an answer. One that ends before it is complete is an error.
pub(in crate::cli) struct Body {
    stream: BufReader<Box<dyn Stream>>,
    left: Left,
}

/// What is left of a body.
#[derive(Clone, Copy, Debug)]
enum Left {
    /// This number of bytes.
    Bytes(u64),
    /// The bytes left of a chunk; more chunks follow.
    Chunk(u64),
    /// A chunk, after the end of another if `true`.
    Chunks(bool),
    Nothing,
}

/// Sends a body of JSON to a path of a host, and reads the head of the answer.
pub(super) fn post(
    stream: TcpStream,
    trust: Option<Trust>,
    (host, path): (&str, &str),
    key: Option<&str>,
    body: &[u8],
) -> anyhow::Result<Answer> {
    let mut stream: Box<dyn Stream> = match trust {
        None => Box::new(stream),
        Some(trust) => {
            let connection = ClientConnection::new(trust.config, trust.name)?;
            Box::new(StreamOwned::new(connection, stream))
        }
    };
    let key = key.map_or(String::new(), |key| {
        format!("authorization: Bearer {key}\r\n")
    });
    let head = format!(
        "POST {path} HTTP/1.1\r\nhost: {host}\r\nconnection: close\r\ncontent-type: application/json\r\n\
         content-length: {}\r\naccept-encoding: identity\r\n{key}\r\n",
        body.len()
    );
    let sent = stream
        .write_all(&[head.as_bytes(), body].concat())
        .and_then(|()| stream.flush());
    let answer = read(BufReader::new(stream));
    match (answer, sent) {
        // What is refused early is not read to its end.
        (Err(_), Err(unsent)) => Err(unsent.into()),
        (answer, _) => answer,
    }
}

/// Reads the head of an answer.
fn read(mut stream: BufReader<Box<dyn Stream>>) -> anyhow::Result<Answer> {
    let mut room = MOST_HEAD;
    let first = line(&mut stream, &mut room)?;
    let status = first
        .strip_prefix("HTTP/1.")
        .and_then(|rest| rest.split_whitespace().nth(1)?.parse().ok());
    let status = status.context("the answer is not HTTP")?;
    let mut headers = vec![];
    loop {
        let line = line(&mut stream, &mut room)?;
        if line.is_empty() {
            break;
        }
        let (name, value) = line.split_once(':').context("the answer is not HTTP")?;
        headers.push((name.to_ascii_lowercase(), value.trim().to_owned()));
    }
    let header = |wanted: &str| {
        let mut all = headers.iter();
        all.find_map(|(name, value)| (name == wanted).then_some(value.as_str()))
    };
    let left = match (header("transfer-encoding"), header("content-length")) {
        (Some(coding), _) if coding.eq_ignore_ascii_case("chunked") => Left::Chunks(false),
        (None, Some(length)) => Left::Bytes(length.parse().context("the answer is not HTTP")?),
        _ => bail!("the answer has no length"),
    };
    if let Some(coding) = header("content-encoding").filter(|coding| *coding != "identity") {
        bail!(
            "the answer is coded as {}; allowed: identity, which was requested",
            shown(coding)
        );
    }
    Ok(Answer {
        status,
        headers,
        body: Body { stream, left },
    })
}

/// The next line without its end.
fn line(stream: &mut impl io::BufRead, room: &mut u64) -> io::Result<String> {
    let mut line = vec![];
    let read = stream.take(*room).read_until(b'\n', &mut line)?;
    *room -= read as u64;
    if line.pop() != Some(b'\n') {
        let kind = match *room {
            0 => io::ErrorKind::InvalidData,
            _ => io::ErrorKind::UnexpectedEof,
        };
        return Err(io::Error::new(kind, "the answer ended early"));
    }
    if line.last() == Some(&b'\r') {
        line.pop();
    }
    String::from_utf8(line).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}

impl Answer {
    /// The value of a header.
    pub(in crate::cli) fn header(&self, wanted: &str) -> Option<&str> {
        let mut all = self.headers.iter();
        all.find_map(|(name, value)| (name == wanted).then_some(value.as_str()))
    }
}

impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Body").field("left", &self.left).finish()
    }
}

impl Body {
    /// The size of the next chunk.
    fn chunk(&mut self, is_after: bool) -> io::Result<u64> {
        let wrong = || io::Error::new(io::ErrorKind::InvalidData, "a chunk without its size");
        let mut room = MOST_HEAD;
        if is_after && !line(&mut self.stream, &mut room)?.is_empty() {
            return Err(wrong());
        }
        let text = line(&mut self.stream, &mut room)?;
        let size = text.split(';').next().unwrap_or_default().trim();
        u64::from_str_radix(size, 16).map_err(|_| wrong())
    }
}

impl Read for Body {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        loop {
            let bytes = match self.left {
                Left::Nothing | Left::Bytes(0) => return Ok(0),
                Left::Chunk(0) => {
                    self.left = Left::Chunks(true);
                    continue;
                }
                Left::Chunks(is_after) => {
                    self.left = match self.chunk(is_after)? {
                        0 => Left::Nothing,
                        size => Left::Chunk(size),
                    };
                    continue;
                }
                Left::Bytes(bytes) | Left::Chunk(bytes) => bytes,
            };
            let most = usize::try_from(bytes).map_or(out.len(), |bytes| bytes.min(out.len()));
            let read = self.stream.read(&mut out[..most])?;
            if read == 0 && most > 0 {
                let detail = "the connection ended before the answer was complete";
                return Err(io::Error::new(io::ErrorKind::UnexpectedEof, detail));
            }
            self.left = match self.left {
                Left::Chunk(bytes) => Left::Chunk(bytes - read as u64),
                _ => Left::Bytes(bytes - read as u64),
            };
            return Ok(read);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is read of an answer, and whether it ends well.
    fn body(text: &str) -> (String, bool) {
        let (text, rest) = (text.to_owned(), vec![]);
        let stream: Box<dyn Stream> = Box::new(Both(io::Cursor::new(text.into_bytes()), rest));
        let mut answer = read(BufReader::new(stream)).expect("a head");
        assert_eq!(answer.header("a"), Some("b"));
        let (mut read, mut part) = (vec![], [0; 3]);
        loop {
            match answer.body.read(&mut part) {
                Ok(0) => return (String::from_utf8_lossy(&read).into(), true),
                Ok(n) => read.extend_from_slice(&part[..n]),
                Err(_) => return (String::from_utf8_lossy(&read).into(), false),
            }
        }
    }

    /// A stream that is read from text.
    struct Both(io::Cursor<Vec<u8>>, Vec<u8>);

    impl Read for Both {
        fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
            self.0.read(out)
        }
    }

    impl Write for Both {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.1.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_body_that_is_cut_is_no_whole_one() {
        let length = "HTTP/1.1 200 OK\r\nA: b\r\ncontent-length: 5\r\n\r\n";
        let chunked = "HTTP/1.1 200 OK\r\nA: b\r\nTransfer-Encoding: chunked\r\n\r\n";
        for (head, rest, expected) in [
            (length, "12345", ("12345", true)),
            (length, "12345678", ("12345", true)),
            (length, "1234", ("1234", false)),
            (
                chunked,
                "4\r\n1234\r\n1;x=y\r\n5\r\n0\r\n\r\n",
                ("12345", true),
            ),
            (chunked, "4\r\n1234\r\n1\r\n5\r\n", ("12345", false)),
            (chunked, "4\r\n12", ("12", false)),
            (chunked, "x\r\n12", ("", false)),
            (chunked, "2\r\n12345\r\n", ("12", false)),
        ] {
            let (text, is_whole) = body(&format!("{head}{rest}"));
            assert_eq!((text.as_str(), is_whole), expected, "{rest:?}");
        }
    }
}
