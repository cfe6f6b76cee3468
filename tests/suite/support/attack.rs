//! Clients at a loopback address of their own, so that limits by address apply to them alone.

use std::{
    io::{self, Write as _},
    net::{Ipv4Addr, SocketAddr, TcpStream},
};

use bytes::Bytes;
use h2::client::SendRequest;
use socket2::{Domain, Socket, Type};

/// The address of clients that misbehave; others use 127.0.0.1.
pub const ATTACKER: Ipv4Addr = Ipv4Addr::new(127, 0, 0, 2);

/// Connects from [`ATTACKER`], with a small buffer for what arrives.
pub fn connect(to: SocketAddr) -> io::Result<TcpStream> {
    connect_from(ATTACKER, to)
}

/// Connects from a loopback address, with a small buffer for what arrives.
pub fn connect_from(from: Ipv4Addr, to: SocketAddr) -> io::Result<TcpStream> {
    let socket = Socket::new(Domain::IPV4, Type::STREAM, None)?;
    socket.set_recv_buffer_size(4096)?;
    socket.bind(&SocketAddr::from((from, 0)).into())?;
    socket.connect(&to.into())?;
    let stream = TcpStream::from(socket);
    stream.set_read_timeout(Some(strew_testkit::wait::PATIENCE))?;
    Ok(stream)
}

/// Sends a GET from [`ATTACKER`] and reads nothing.
pub fn get(to: SocketAddr, path: &str, headers: &str) -> io::Result<TcpStream> {
    let mut stream = connect(to)?;
    write!(stream, "GET {path} HTTP/1.1\r\nhost: {to}\r\n{headers}\r\n")?;
    Ok(stream)
}

/// An HTTP/2 connection from [`ATTACKER`] that grants no window for answers. The task ends with the
/// connection.
pub async fn without_window(
    to: SocketAddr,
) -> io::Result<(SendRequest<Bytes>, tokio::task::JoinHandle<()>)> {
    let socket = tokio::net::TcpSocket::new_v4()?;
    socket.bind(SocketAddr::from((ATTACKER, 0)))?;
    let stream = socket.connect(to).await?;
    let (client, connection) = h2::client::Builder::new()
        .initial_window_size(0)
        .handshake(stream)
        .await
        .map_err(io::Error::other)?;
    let ended = tokio::spawn(async move {
        let _ = connection.await;
    });
    Ok((client, ended))
}
