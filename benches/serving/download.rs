//! The least a client can do over HTTP/1.1: send a request, read, throw away.

use std::{
    io::Read as _,
    net::{SocketAddr, TcpStream},
};

use strew_testkit::http1;

/// Requests a path and reads nothing yet. The response ends with the connection.
pub fn open(address: SocketAddr, path: &str) -> TcpStream {
    http1::send(address, "GET", path, &[], None).expect("sent")
}

/// Requests a path and reads the response to its end. Returns its size in bytes, head included.
pub fn whole(address: SocketAddr, path: &str) -> u64 {
    let mut stream = open(address, path);
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
