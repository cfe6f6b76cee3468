//! A server in front of a daemon that refuses requests for points, or never answers them, until it is told otherwise.

use std::{
    io::{Read, Write},
    net::{Shutdown, SocketAddr, TcpListener, TcpStream},
    sync::{Arc, Mutex, PoisonError},
    thread,
};

/// The answer to requests for points.
#[derive(Clone, Copy, Debug)]
pub enum Points {
    /// The daemon answers them.
    Pass,
    /// They are refused with a status and words of an API; with a time to wait, in seconds.
    Refuse(u16, u32),
    /// They are never answered.
    Hang,
}

/// The server; it ends with the process of the tests.
pub struct Front {
    address: SocketAddr,
    state: Arc<Mutex<(Points, Vec<TcpStream>)>>,
}

impl Front {
    /// Starts one in front of a daemon.
    pub fn of(daemon: SocketAddr, points: Points) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = listener.local_addr().expect("bound");
        let state = Arc::new(Mutex::new((points, vec![])));
        let shared = Arc::clone(&state);
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let state = Arc::clone(&shared);
                thread::spawn(move || drop(answer(stream, daemon, &state)));
            }
        });
        Self { address, state }
    }

    /// The address of a path.
    pub fn url(&self, path: &str) -> String {
        format!("http://{}{path}", self.address)
    }

    /// Says what becomes of requests from now on. Those without an answer are cut off.
    pub fn set(&self, points: Points) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        for held in state.1.drain(..) {
            let _ = held.shutdown(Shutdown::Both);
        }
        state.0 = points;
    }
}

type State = Mutex<(Points, Vec<TcpStream>)>;

/// Answers the one request of a connection.
fn answer(mut client: TcpStream, daemon: SocketAddr, state: &State) -> std::io::Result<()> {
    let mut head = vec![];
    let mut byte = [0];
    while !head.ends_with(b"\r\n\r\n") {
        if client.read(&mut byte)? == 0 {
            return Ok(());
        }
        head.push(byte[0]);
    }
    let head = String::from_utf8_lossy(&head).into_owned();
    let is_for_points = ["/v1/chunks/", "/v1/points"]
        .iter()
        .any(|path| head.contains(path));
    {
        let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
        match state.0 {
            Points::Refuse(status, wait) if is_for_points => {
                let body =
                    r#"{"title":"No","detail":"`limits.max_points` = 5000000: words of an API"}"#;
                return write!(
                    client,
                    "HTTP/1.1 {status} No\r\ncontent-type: application/problem+json\r\nretry-after: {wait}\r\n\
                     content-length: {}\r\nconnection: close\r\n\r\n{body}",
                    body.len()
                );
            }
            Points::Hang if is_for_points => {
                state.1.push(client);
                return Ok(());
            }
            _ => {}
        }
    }
    let mut server = TcpStream::connect(daemon)?;
    let (line, rest) = head.split_once("\r\n").unwrap_or((&head, ""));
    let rest: String = rest
        .split_inclusive("\r\n")
        .filter(|line| !line.to_ascii_lowercase().starts_with("connection:"))
        .collect();
    write!(server, "{line}\r\nconnection: close\r\n{rest}")?;
    let mut up = client.try_clone()?;
    let mut to = server.try_clone()?;
    thread::spawn(move || std::io::copy(&mut up, &mut to));
    std::io::copy(&mut server, &mut client)?;
    client.shutdown(Shutdown::Both)
}
