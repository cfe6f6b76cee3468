//! A client of a daemon that serves TLS.

use std::{
    io::{Read as _, Write as _},
    net::TcpStream,
    sync::Arc,
};

use rustls::{
    ClientConfig, ClientConnection, RootCertStore, StreamOwned,
    crypto::ring::default_provider,
    pki_types::{CertificateDer, PrivateKeyDer, PrivatePkcs8KeyDer, ServerName},
};
use strew_testkit::{
    certificates::{Authority, Certificate},
    http1,
};

use super::daemon::Daemon;

/// The configuration of a client: the authority it trusts, the certificate it presents.
pub fn client(
    trusted: &Authority,
    shown: Option<&Certificate>,
    protocols: &[&[u8]],
) -> Arc<ClientConfig> {
    let mut roots = RootCertStore::empty();
    roots
        .add(CertificateDer::from(trusted.der()))
        .expect("a certificate");
    let builder = ClientConfig::builder_with_provider(Arc::new(default_provider()))
        .with_safe_default_protocol_versions()
        .expect("versions")
        .with_root_certificates(roots);
    let mut config = match shown {
        None => builder.with_no_client_auth(),
        Some(issued) => {
            let key = PrivateKeyDer::Pkcs8(PrivatePkcs8KeyDer::from(issued.key_der.clone()));
            let chain = vec![CertificateDer::from(issued.der.clone())];
            builder.with_client_auth_cert(chain, key).expect("a pair")
        }
    };
    config.alpn_protocols = protocols.iter().map(|name| name.to_vec()).collect();
    Arc::new(config)
}

/// A connection over TLS.
pub type Connected = StreamOwned<ClientConnection, TcpStream>;

/// Connects to a daemon.
pub fn connect(daemon: &Daemon, config: &Arc<ClientConfig>) -> Connected {
    let stream = http1::connect(daemon.address()).expect("connected");
    let name = ServerName::try_from("localhost").expect("a name");
    let connection = ClientConnection::new(config.clone(), name).expect("a client");
    StreamOwned::new(connection, stream)
}

/// Requests a path over an open connection, and reads a body of known length.
pub fn get(connected: &mut Connected, path: &str) -> std::io::Result<String> {
    get_with(connected, path, "")
}

/// As [`get`], with headers: lines that end in CR LF.
pub fn get_with(connected: &mut Connected, path: &str, headers: &str) -> std::io::Result<String> {
    let request = format!("GET {path} HTTP/1.1\r\nhost: localhost\r\n{headers}\r\n");
    connected.write_all(request.as_bytes())?;
    let mut bytes = Vec::new();
    let mut buffer = [0; 4096];
    loop {
        let text = String::from_utf8_lossy(&bytes).into_owned();
        if let Some((head, body)) = text.split_once("\r\n\r\n") {
            let length = head
                .lines()
                .find_map(|line| line.strip_prefix("content-length: ")?.parse().ok())
                .unwrap_or(0);
            if body.len() >= length {
                return Ok(text);
            }
        }
        match connected.read(&mut buffer)? {
            0 => return Err(std::io::ErrorKind::UnexpectedEof.into()),
            read => bytes.extend_from_slice(&buffer[..read]),
        }
    }
}

/// The certificate that the daemon presents to a new connection.
pub fn shown(daemon: &Daemon, config: &Arc<ClientConfig>) -> Vec<u8> {
    let mut connected = connect(daemon, config);
    get(&mut connected, "/livez").expect("an answer");
    let chain = connected.conn.peer_certificates().expect("shown");
    chain[0].to_vec()
}
