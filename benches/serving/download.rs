//! The least a client can do over HTTP/1.1: ask, read, throw away.

use std::{
    io::{Read as _, Write as _},
    net::{SocketAddr, TcpStream},
};

/// Opens a connection and asks for a path; the answer ends with the connection.
pub fn ask(address: SocketAddr, path: &str) -> TcpStream {
    let mut stream = TcpStream::connect(address).expect("a listener");
    let head = format!("GET {path} HTTP/1.1\r\nhost: bench\r\nconnection: close\r\n\r\n");
    stream.write_all(head.as_bytes()).expect("sent");
    stream
}

/// Reads an answer to its end and gives its size, head included.
pub fn drain(mut stream: TcpStream) -> u64 {
    let mut buffer = vec![0; 1 << 20];
    let mut total = 0;
    loop {
        match stream.read(&mut buffer).expect("readable") {
            0 => return total,
            read => {
                if total == 0 {
                    let head = String::from_utf8_lossy(&buffer[..read.min(64)]);
                    assert!(head.starts_with("HTTP/1.1 200"), "{head}");
                }
                total += read as u64;
            }
        }
    }
}

/// Asks and reads all of the answer.
pub fn get(address: SocketAddr, path: &str) -> u64 {
    drain(ask(address, path))
}
