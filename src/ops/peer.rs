//! The other end of a connection.

use std::net::SocketAddr;

/// The address of a connection's other end: a client, or a proxy before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Peer(pub SocketAddr);
