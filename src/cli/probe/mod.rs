//! `strew probe`: asks a daemon whether it lives or takes requests, for health checks of containers
//! that have no other program in them.
//!
//! A few lines of HTTP/1.1 by hand, in TLS if the daemon speaks it: the whole exchange has one
//! deadline, whatever the other side does.

mod trust;
mod verifier;

use std::{
    io::{self, Read, Write},
    net::{SocketAddr, TcpStream, ToSocketAddrs as _},
    time::{Duration, Instant},
};

use anyhow::{Context as _, anyhow, bail};
use rustls::{AlertDescription, ClientConnection, StreamOwned};

pub(super) use self::trust::{OVER_HTTP, Trust, TrustArgs};
use super::{Failure, config};

/// Flags of `strew probe`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Where the daemon is, such as http://127.0.0.1:8080 or https://strew.example. Default: where
    /// the settings say that it listens, and by TLS if they say so.
    #[arg(long, value_name = "URL")]
    url: Option<String>,
    /// Ask whether it takes requests (/readyz). This is the default.
    #[arg(long, conflicts_with = "live")]
    ready: bool,
    /// Ask only whether it lives (/livez).
    #[arg(long)]
    live: bool,
    /// How long the answer may take, in seconds.
    #[arg(long, value_name = "SECONDS", default_value = "2")]
    timeout: f64,
    #[command(flatten)]
    trust: TrustArgs,
    #[command(flatten)]
    settings: config::Served,
}

/// More than any answer to a probe.
const MOST_BYTES: usize = 64 << 10;

/// Ends well if the daemon says yes.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let timeout = Duration::try_from_secs_f64(args.timeout)
        .ok()
        .filter(|timeout| (Duration::from_millis(1)..=HOUR).contains(timeout));
    let timeout = timeout.ok_or_else(|| {
        let value = args.timeout;
        usage(anyhow!("--timeout {value}: allowed: 0.001 to 3600 seconds"))
    })?;
    let (is_tls, host) = match &args.url {
        Some(url) => {
            let why = "--url has the address";
            args.settings.must_be_unused(why)?;
            host(url).map_err(usage)?
        }
        None => {
            let settings = args.settings.merged()?;
            let host = local(settings.server.listen).map_err(usage)?;
            (settings.tls.is_on(), host)
        }
    };
    let trust = match is_tls {
        true => args.trust.trust(&host, args.url.is_none()).map(Some),
        false => args.trust.must_be_unused(OVER_HTTP).map(|()| None),
    };
    let trust = trust.map_err(usage)?;
    let scheme = if is_tls { "https" } else { "http" };
    let path = if args.live { "/livez" } else { "/readyz" };
    let url = format!("{scheme}://{host}{path}");
    let status = ask(&host, path, trust, timeout).with_context(|| url.clone())?;
    if status == 200 {
        return Ok(());
    }
    let what = if args.live { "alive" } else { "ready" };
    Err(anyhow!("{url}: not {what}: status {status}").into())
}

const HOUR: Duration = Duration::from_secs(3600);

fn usage(error: anyhow::Error) -> Failure {
    Failure::Usage(error)
}

/// Whether a URL asks for TLS, and its host and port.
pub(super) fn host(url: &str) -> anyhow::Result<(bool, String)> {
    let wrong = || anyhow!("--url {url}: allowed: http://host:port or https://host:port");
    let (scheme, rest) = url.split_once("://").ok_or_else(wrong)?;
    let host = rest.strip_suffix('/').unwrap_or(rest);
    let is_odd = |c: char| c.is_whitespace() || c.is_control() || "/?#@".contains(c);
    let (is_tls, port) = match scheme {
        "http" => (false, 80),
        "https" => (true, 443),
        _ => return Err(wrong()),
    };
    if host.is_empty() || host.contains(is_odd) {
        return Err(wrong());
    }
    let has_port = host
        .rsplit_once(':')
        .is_some_and(|(_, port)| port.parse::<u16>().is_ok());
    let host = if has_port {
        host.into()
    } else {
        format!("{host}:{port}")
    };
    Ok((is_tls, host))
}

/// Where a daemon of this machine is reached that listens there.
fn local(mut listen: SocketAddr) -> anyhow::Result<String> {
    if listen.port() == 0 {
        bail!("server.listen = {listen}: the port is only known to the daemon; name it with --url");
    }
    if listen.ip().is_unspecified() {
        listen.set_ip(match listen {
            SocketAddr::V4(_) => std::net::Ipv4Addr::LOCALHOST.into(),
            SocketAddr::V6(_) => std::net::Ipv6Addr::LOCALHOST.into(),
        });
    }
    Ok(listen.to_string())
}

/// The status of an answer.
fn ask(host: &str, path: &str, trust: Option<Trust>, timeout: Duration) -> anyhow::Result<u16> {
    let end = Instant::now() + timeout;
    let asked = connect(host, end).and_then(|stream| {
        let stream = Timed { stream, end };
        match trust {
            None => exchange(stream, host, path),
            Some(trust) => {
                let connection = ClientConnection::new(trust.config, trust.name)?;
                exchange(StreamOwned::new(connection, stream), host, path)
            }
        }
    });
    asked.map_err(|error| explained(error, timeout))
}

/// An error of a connection in words that say what to do.
pub(super) fn explained(error: anyhow::Error, timeout: Duration) -> anyhow::Error {
    match error.downcast_ref::<io::Error>() {
        Some(error) if is_late(error) => anyhow!("no answer within {timeout:?}"),
        Some(cause) if wants_certificate(cause) => {
            error.context("it wants a certificate: use --certificate and --key")
        }
        _ => error,
    }
}

/// Asks, and reads the first line of the answer.
fn exchange(mut stream: impl Read + Write, host: &str, path: &str) -> anyhow::Result<u16> {
    let request = format!("GET {path} HTTP/1.1\r\nhost: {host}\r\nconnection: close\r\n\r\n");
    stream.write_all(request.as_bytes())?;
    stream.flush()?;
    let (mut head, mut part) = (vec![], [0; 4096]);
    while !head.contains(&b'\n') {
        match stream.read(&mut part) {
            Ok(0) => bail!("the connection ended without an answer"),
            Ok(read) => head.extend_from_slice(&part[..read]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error.into()),
        }
        if head.len() > MOST_BYTES {
            bail!("the answer is not HTTP");
        }
    }
    let line = String::from_utf8_lossy(&head);
    let status = line
        .strip_prefix("HTTP/1.")
        .and_then(|rest| rest.split_whitespace().nth(1)?.parse().ok());
    status.context("the answer is not HTTP")
}

fn is_late(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut
    )
}

/// Whether a daemon refused us for want of a certificate: TLS 1.3 has a word for it, 1.2 has not.
fn wants_certificate(error: &io::Error) -> bool {
    let cause = error.get_ref().and_then(|cause| cause.downcast_ref());
    matches!(
        cause,
        Some(rustls::Error::AlertReceived(
            AlertDescription::CertificateRequired
        ))
    )
}

/// A connection whose reads and writes all have to be done by one time, also those of a handshake.
struct Timed {
    stream: TcpStream,
    end: Instant,
}

/// The time that is left until then.
fn left(end: Instant) -> io::Result<Duration> {
    let left = end.saturating_duration_since(Instant::now());
    let is_over = left.is_zero();
    (!is_over)
        .then_some(left)
        .ok_or_else(|| io::ErrorKind::TimedOut.into())
}

impl Read for Timed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(Some(left(self.end)?))?;
        self.stream.read(buffer)
    }
}

impl Write for Timed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(Some(left(self.end)?))?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// A connection to the first address of a host that takes one.
pub(super) fn connect(host: &str, end: Instant) -> anyhow::Result<TcpStream> {
    let mut last = anyhow!("the name has no address");
    for address in host.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, left(end)?) {
            Ok(stream) => return Ok(stream),
            Err(error) => last = error.into(),
        }
    }
    Err(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_url_is_a_scheme_a_host_and_a_port() {
        for (url, expected) in [
            ("http://127.0.0.1:8080", (false, "127.0.0.1:8080")),
            ("http://127.0.0.1:8080/", (false, "127.0.0.1:8080")),
            ("http://[::1]:8080", (false, "[::1]:8080")),
            ("http://strew", (false, "strew:80")),
            ("https://strew", (true, "strew:443")),
            ("https://strew:8443/", (true, "strew:8443")),
        ] {
            let (is_tls, host) = host(url).expect(url);
            assert_eq!((is_tls, &*host), expected);
        }
        for url in [
            "",
            "strew",
            "ftp://a:1",
            "http://",
            "http://a/readyz",
            "http://u@a",
            "http://a b",
        ] {
            let error = host(url).expect_err(url).to_string();
            assert!(error.contains("allowed: http://host:port"), "{error}");
        }
    }

    #[test]
    fn a_daemon_that_listens_everywhere_is_reached_here() {
        let of = |text: &str| local(text.parse().expect("an address"));
        assert_eq!(of("0.0.0.0:80").expect("a port"), "127.0.0.1:80");
        assert_eq!(of("[::]:80").expect("a port"), "[::1]:80");
        assert_eq!(of("10.1.2.3:80").expect("a port"), "10.1.2.3:80");
        assert!(of("127.0.0.1:0").is_err());
    }
}
