//! A plain HTTP/1.1 client: sends any bytes, and lets a body be read as slowly as one likes.

use std::{
    collections::BTreeMap,
    io::{BufRead as _, BufReader, Read, Write as _},
    net::TcpStream,
};

use crate::daemon::PATIENCE;

/// A whole answer.
pub struct Answer {
    pub status: u16,
    pub headers: BTreeMap<String, String>,
    pub body: Vec<u8>,
}

impl Answer {
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

/// An answer whose body is still to be read.
pub struct Opened {
    pub status: u16,
    pub headers: BTreeMap<String, String>,
    stream: BufReader<TcpStream>,
}

/// Sends a request and reads the head of the answer.
pub fn open(address: &str, method: &str, path: &str, headers: &[(&str, &str)]) -> Opened {
    send(address, method, path, headers, &[])
}

/// Sends a request with a body and reads the head of the answer.
pub fn post(address: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Opened {
    let length = body.len().to_string();
    let mut all = vec![("content-length", length.as_str())];
    all.extend(headers);
    send(address, "POST", path, &all, body)
}

fn send(address: &str, method: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Opened {
    let mut stream = TcpStream::connect(address).expect("connected");
    stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
    let mut request = format!("{method} {path} HTTP/1.1\r\nhost: {address}\r\n");
    for (name, value) in headers {
        request += &format!("{name}: {value}\r\n");
    }
    request += "connection: close\r\n\r\n";
    stream.write_all(request.as_bytes()).expect("sent");
    stream.write_all(body).expect("sent");
    let mut stream = BufReader::new(stream);
    let mut line = String::new();
    stream.read_line(&mut line).expect("a status line");
    let status = line
        .split(' ')
        .nth(1)
        .and_then(|code| code.parse().ok())
        .unwrap_or_else(|| panic!("no status: {line:?}"));
    let mut headers = BTreeMap::new();
    loop {
        line.clear();
        stream.read_line(&mut line).expect("a header");
        let Some((name, value)) = line.trim_end().split_once(':') else {
            break;
        };
        headers.insert(name.to_ascii_lowercase(), value.trim().to_owned());
    }
    Opened {
        status,
        headers,
        stream,
    }
}

impl Opened {
    /// Reads some bytes as they come, with HTTP's framing left in.
    pub fn read(&mut self, bytes: usize) -> std::io::Result<usize> {
        let mut buffer = vec![0; bytes];
        self.stream.read(&mut buffer)
    }

    /// Reads to the end, with HTTP's framing left in.
    pub fn rest(mut self) -> String {
        let mut text = String::new();
        self.stream.read_to_string(&mut text).expect("UTF-8");
        text
    }

    /// Reads to the end without keeping anything; whether the answer was complete.
    pub fn drain(mut self) -> bool {
        let expected = self.headers.get("content-length");
        let expected = expected.map(|v| v.parse::<u64>().expect("a number"));
        let (mut buffer, mut read, mut end) = (vec![0; 1 << 18], 0, vec![]);
        let ended = loop {
            match self.stream.read(&mut buffer) {
                Ok(0) => break true,
                Ok(n) => {
                    read += n as u64;
                    end = buffer[n.saturating_sub(5)..n].to_vec();
                }
                Err(_) => break false,
            }
        };
        ended && expected.map_or(end == b"0\r\n\r\n", |expected| expected == read)
    }

    /// The body of a server that says its length and then keeps the connection.
    pub fn body(mut self) -> Vec<u8> {
        let length = self.headers.get("content-length");
        let length = length.and_then(|v| v.parse().ok()).expect("a length");
        let mut body = vec![0; length];
        self.stream.read_exact(&mut body).expect("a whole body");
        body
    }

    /// Reads to the end: the body, and whether it was complete.
    pub fn finish(mut self) -> (Vec<u8>, bool) {
        let chunked = self
            .headers
            .get("transfer-encoding")
            .is_some_and(|v| v == "chunked");
        if chunked {
            return self.finish_chunked();
        }
        let expected = self.headers.get("content-length");
        let expected = expected.map(|v| v.parse::<u64>().expect("a number"));
        let mut body = vec![];
        let read = self.stream.read_to_end(&mut body).is_ok();
        let complete = read && expected.is_none_or(|n| n == body.len() as u64);
        (body, complete)
    }

    fn finish_chunked(mut self) -> (Vec<u8>, bool) {
        let mut body = vec![];
        loop {
            let mut line = String::new();
            if !matches!(self.stream.read_line(&mut line), Ok(1..)) {
                return (body, false);
            }
            let size = usize::from_str_radix(line.trim(), 16).expect("a chunk's size");
            let mut chunk = vec![0; size + 2];
            if self.stream.read_exact(&mut chunk).is_err() {
                return (body, false);
            }
            if size == 0 {
                return (body, true);
            }
            body.extend_from_slice(&chunk[..size]);
        }
    }
}

/// A whole answer to GET, complete.
pub fn get(address: &str, path: &str, headers: &[(&str, &str)]) -> Answer {
    request(address, "GET", path, headers)
}

/// A whole answer to a body, complete.
pub fn posted(address: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Answer {
    let opened = post(address, path, headers, body);
    let (status, headers) = (opened.status, opened.headers.clone());
    let (body, complete) = opened.finish();
    assert!(complete, "{path} broke off");
    Answer {
        status,
        headers,
        body,
    }
}

/// A whole answer, complete.
pub fn request(address: &str, method: &str, path: &str, headers: &[(&str, &str)]) -> Answer {
    let opened = open(address, method, path, headers);
    let (status, headers) = (opened.status, opened.headers.clone());
    let (body, complete) = if method == "HEAD" {
        (vec![], true)
    } else {
        opened.finish()
    };
    assert!(complete, "{method} {path} broke off");
    Answer {
        status,
        headers,
        body,
    }
}
