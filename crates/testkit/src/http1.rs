//! A plain HTTP/1.1 client. It sends any bytes, and reads a body as slowly as the caller likes.
//!
//! Each request opens a connection of its own and asks the server to close it. [`connect`],
//! [`send`] and [`try_open`] return errors, for callers that count failures; the other functions
//! panic.

use std::{
    collections::BTreeMap,
    io::{self, BufRead as _, BufReader, Read, Write as _},
    net::{SocketAddr, TcpStream},
    time::Duration,
};

/// How long a client waits to connect, and for the next bytes.
pub const TIMEOUT: Duration = Duration::from_secs(60);

/// The size of the read buffer, in bytes.
const BUFFER: usize = 1 << 16;

/// Opens a connection whose reads and writes end after [`TIMEOUT`].
pub fn connect(address: SocketAddr) -> io::Result<TcpStream> {
    let stream = TcpStream::connect_timeout(&address, TIMEOUT)?;
    stream.set_read_timeout(Some(TIMEOUT))?;
    stream.set_write_timeout(Some(TIMEOUT))?;
    stream.set_nodelay(true)?;
    Ok(stream)
}

/// Sends a request and reads nothing. A body is announced by its length.
pub fn send(
    address: SocketAddr,
    method: &str,
    path: &str,
    headers: &[(&str, &str)],
    body: Option<&[u8]>,
) -> io::Result<TcpStream> {
    let mut request = format!("{method} {path} HTTP/1.1\r\nconnection: close\r\n");
    if headers.iter().all(|(name, _)| *name != "host") {
        request += &format!("host: {address}\r\n");
    }
    if let Some(body) = body {
        request += &format!("content-length: {}\r\n", body.len());
    }
    for (name, value) in headers {
        request += &format!("{name}: {value}\r\n");
    }
    request += "\r\n";
    let mut request = request.into_bytes();
    request.extend_from_slice(body.unwrap_or_default());
    let mut stream = connect(address)?;
    stream.write_all(&request)?;
    Ok(stream)
}

pub fn try_open(
    address: SocketAddr,
    method: &str,
    path: &str,
    headers: &[(&str, &str)],
    body: Option<&[u8]>,
) -> io::Result<Response> {
    Response::read_head(send(address, method, path, headers, body)?, method)
}

/// Sends a request without a body and reads the head of the response.
pub fn open(address: SocketAddr, method: &str, path: &str, headers: &[(&str, &str)]) -> Response {
    try_open(address, method, path, headers, None)
        .unwrap_or_else(|e| panic!("{method} {path}: {e}"))
}

pub fn open_post(
    address: SocketAddr,
    path: &str,
    headers: &[(&str, &str)],
    body: &[u8],
) -> Response {
    try_open(address, "POST", path, headers, Some(body))
        .unwrap_or_else(|e| panic!("POST {path}: {e}"))
}

/// The whole response to a request without a body.
pub fn request(address: SocketAddr, method: &str, path: &str, headers: &[(&str, &str)]) -> Answer {
    let response = open(address, method, path, headers);
    response.answer(&format!("{method} {path}"))
}

pub fn get(address: SocketAddr, path: &str, headers: &[(&str, &str)]) -> Answer {
    request(address, "GET", path, headers)
}

pub fn post(address: SocketAddr, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Answer {
    let response = open_post(address, path, headers, body);
    response.answer(&format!("POST {path}"))
}

/// Reads what arrives until the connection ends, by a close or by a reset.
pub fn read_to_close(mut stream: TcpStream) -> String {
    let mut bytes = vec![];
    let _ = stream.read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

pub struct Answer {
    pub status: u16,
    pub headers: BTreeMap<String, String>,
    pub body: Vec<u8>,
}

impl Answer {
    /// The value of a header, by its lower-case name; empty if it is missing.
    pub fn header(&self, name: &str) -> &str {
        self.headers.get(name).map_or("", String::as_str)
    }

    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.body).expect("UTF-8")
    }

    pub fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|e| panic!("{e}: {}", self.text()))
    }
}

/// A response whose body is still to be read. [`Read`] yields the body without HTTP's framing; a
/// body that breaks off is an [`io::ErrorKind::UnexpectedEof`].
pub struct Response {
    pub status: u16,
    pub headers: BTreeMap<String, String>,
    stream: BufReader<TcpStream>,
    left: Left,
}

/// The part of a body that is still to be read (RFC 9112, section 6.3).
enum Left {
    Bytes(u64),
    /// Of the current chunk; at 0 the end of its line and the next chunk follow.
    Chunk(u64),
    NextChunk,
    UntilClose,
    Nothing,
}

impl Left {
    fn of(method: &str, status: u16, headers: &BTreeMap<String, String>) -> io::Result<Self> {
        if method == "HEAD" || matches!(status, 100..200 | 204 | 304) {
            return Ok(Self::Nothing);
        }
        if headers
            .get("transfer-encoding")
            .is_some_and(|v| v == "chunked")
        {
            return Ok(Self::NextChunk);
        }
        match headers.get("content-length").map(|text| text.parse()) {
            Some(Ok(length)) => Ok(Self::Bytes(length)),
            Some(Err(_)) => Err(io::ErrorKind::InvalidData.into()),
            None => Ok(Self::UntilClose),
        }
    }
}

/// A line without its end; a part of a line is an error.
fn line(stream: &mut BufReader<TcpStream>) -> io::Result<String> {
    let mut line = String::new();
    stream.read_line(&mut line)?;
    match line.strip_suffix("\r\n") {
        Some(line) => Ok(line.to_owned()),
        None => Err(io::ErrorKind::UnexpectedEof.into()),
    }
}

impl Response {
    /// Reads the head of the response to a request that was sent by hand.
    pub fn read_head(stream: TcpStream, method: &str) -> io::Result<Self> {
        let mut stream = BufReader::with_capacity(BUFFER, stream);
        let status = line(&mut stream)?;
        let status = status.split(' ').nth(1).and_then(|code| code.parse().ok());
        let status = status.ok_or(io::ErrorKind::InvalidData)?;
        let mut headers = BTreeMap::new();
        while let Some((name, value)) = line(&mut stream)?.split_once(':') {
            headers.insert(name.to_ascii_lowercase(), value.trim().to_owned());
        }
        Ok(Self {
            status,
            left: Left::of(method, status, &headers)?,
            headers,
            stream,
        })
    }

    /// The value of a header, by its lower-case name; empty if it is missing.
    pub fn header(&self, name: &str) -> &str {
        self.headers.get(name).map_or("", String::as_str)
    }

    /// Reads up to `most` bytes of the body and throws them away. Returns how many they were.
    pub fn skip(&mut self, most: usize) -> io::Result<usize> {
        self.read(&mut vec![0; most])
    }

    pub fn body(mut self) -> io::Result<Vec<u8>> {
        let mut body = vec![];
        self.read_to_end(&mut body)?;
        Ok(body)
    }

    /// Reads to the end of the connection. Returns the body, and whether it was complete and
    /// nothing followed it.
    pub fn finish(mut self) -> (Vec<u8>, bool) {
        let mut body = vec![];
        let is_complete = self.read_to_end(&mut body).is_ok() && self.is_closed();
        (body, is_complete)
    }

    /// Reads to the end of the connection and keeps nothing. Returns whether the body was complete
    /// and nothing followed it.
    pub fn drain(mut self) -> bool {
        io::copy(&mut self, &mut io::sink()).is_ok() && self.is_closed()
    }

    /// Everything that arrives until the connection ends, HTTP's framing included.
    pub fn raw_rest(mut self) -> Vec<u8> {
        let mut bytes = vec![];
        self.stream.read_to_end(&mut bytes).expect("readable");
        bytes
    }

    /// The whole response, which must be complete; `what` names it in the message if it is not.
    fn answer(self, what: &str) -> Answer {
        let (status, headers) = (self.status, self.headers.clone());
        let (body, is_complete) = self.finish();
        assert!(is_complete, "the response to {what} broke off");
        Answer {
            status,
            headers,
            body,
        }
    }

    fn is_closed(&mut self) -> bool {
        matches!(self.stream.read(&mut [0]), Ok(0))
    }

    fn next_chunk(&mut self) -> io::Result<Left> {
        let size = line(&mut self.stream)?;
        let size = u64::from_str_radix(&size, 16).map_err(|_| io::ErrorKind::InvalidData)?;
        if size > 0 {
            return Ok(Left::Chunk(size));
        }
        // Trailers end with an empty line.
        while !line(&mut self.stream)?.is_empty() {}
        Ok(Left::Nothing)
    }
}

impl Read for Response {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if let Left::Chunk(0) = self.left {
            line(&mut self.stream)?;
            self.left = Left::NextChunk;
        }
        if let Left::NextChunk = self.left {
            self.left = self.next_chunk()?;
        }
        let left = match self.left {
            Left::Nothing | Left::NextChunk | Left::Bytes(0) => return Ok(0),
            Left::UntilClose => return self.stream.read(into),
            Left::Bytes(left) | Left::Chunk(left) => left,
        };
        let room = into.len().min(usize::try_from(left).unwrap_or(usize::MAX));
        if room == 0 {
            return Ok(0);
        }
        let read = self.stream.read(&mut into[..room])?;
        if read == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        if let Left::Bytes(left) | Left::Chunk(left) = &mut self.left {
            *left -= read as u64;
        }
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use super::*;

    /// The response to a request, from a server that sends these bytes and closes the connection.
    fn response(method: &str, bytes: &'static str) -> Response {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = listener.local_addr().expect("bound");
        let server = std::thread::spawn(move || {
            let (mut stream, _) = listener.accept().expect("a client");
            let mut request = BufReader::new(&stream);
            while !line_of(&mut request).is_empty() {}
            drop(request);
            stream.write_all(bytes.as_bytes()).expect("sent");
        });
        let response = open(address, method, "/", &[]);
        server.join().expect("no panic");
        response
    }

    fn line_of(request: &mut impl io::BufRead) -> String {
        let mut line = String::new();
        request.read_line(&mut line).expect("readable");
        line.trim_end().to_owned()
    }

    #[test]
    fn bodies_are_read_by_their_framing() {
        for bytes in [
            "HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\nabcde",
            "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n",
            "HTTP/1.1 200 OK\r\n\r\nabcde",
        ] {
            let response = response("GET", bytes);
            assert_eq!(response.status, 200);
            assert_eq!(response.finish(), (b"abcde".to_vec(), true), "{bytes}");
        }
        let length = "HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\n";
        let head = response("HEAD", length);
        assert_eq!(head.header("content-length"), "5");
        assert_eq!(head.finish(), (vec![], true));
    }

    #[test]
    fn bodies_that_break_off_are_not_complete() {
        for (bytes, arrived) in [
            ("HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\nabc", "abc"),
            (
                "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n",
                "abc",
            ),
            (
                "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n",
                "abc",
            ),
            (
                "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n9\r\nabc",
                "abc",
            ),
            ("HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\nabc", "ab"),
        ] {
            assert!(!response("GET", bytes).drain(), "{bytes}");
            let (body, is_complete) = response("GET", bytes).finish();
            assert!(!is_complete, "{bytes}");
            assert_eq!(body, arrived.as_bytes(), "{bytes}");
        }
    }
}
