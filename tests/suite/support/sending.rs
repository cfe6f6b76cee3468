//! Bodies sent from an address that others do not use.

use std::{
    io::{self, Read as _, Write as _},
    net::{SocketAddr, TcpStream},
};

use serde_json::Value;

use super::attack;

/// Sends a POST from another address than others use; its answer is read later.
pub fn post(to: SocketAddr, path: &str, body: &str) -> io::Result<TcpStream> {
    let mut stream = attack::connect(to)?;
    let length = body.len();
    write!(
        stream,
        "POST {path} HTTP/1.1\r\nhost: {to}\r\nconnection: close\r\ncontent-length: {length}\r\n\r\n{body}"
    )?;
    Ok(stream)
}

/// Sends a field or a list from another address than others use. Returns its digest.
pub fn digest(to: SocketAddr, path: &str, body: &str) -> String {
    let text = answer(&mut post(to, path, body).expect("sent"));
    assert!(text.starts_with("HTTP/1.1 200"), "{text}");
    let body = text.split("\r\n\r\n").nth(1).expect("a body");
    let body: Value = serde_json::from_str(body).expect("JSON");
    body["digest"].as_str().expect("a digest").into()
}

/// The answer to the bytes sent, head and body.
pub fn answer(stream: &mut TcpStream) -> String {
    let mut text = vec![];
    stream.read_to_end(&mut text).expect("an answer");
    String::from_utf8_lossy(&text).into_owned()
}
