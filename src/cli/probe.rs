//! `strew probe`: requests the health of a daemon, for health checks of containers that hold no other program.

use std::{
    io,
    net::{IpAddr, SocketAddr},
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use anyhow::{Context as _, anyhow, bail};
use bytes::Bytes;
use http::{
    Request, StatusCode, Uri,
    header::{CONNECTION, HOST},
};
use http_body_util::Empty;
use hyper::client::conn::http1;
use hyper_util::rt::TokioIo;
use rustls::{
    AlertDescription, CertificateError, ClientConfig, DigitallySignedStruct, RootCertStore,
    SignatureScheme,
    client::{
        WebPkiServerVerifier,
        danger::{HandshakeSignatureValid, ServerCertVerified, ServerCertVerifier},
        verify_server_name,
    },
    crypto::{
        WebPkiSupportedAlgorithms, ring::default_provider, verify_tls12_signature,
        verify_tls13_signature,
    },
    pki_types::{CertificateDer, PrivateKeyDer, ServerName, UnixTime, pem::PemObject as _},
    server::ParsedCertificate,
};
use strew_config::bounded_file;
use tokio::{
    io::{AsyncRead, AsyncWrite},
    net::TcpStream,
};
use tokio_rustls::TlsConnector;

use super::{Failure, config, must_be_within, refuse};
use crate::ops::tls::{certificates, validity};

/// Flags of `strew probe`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Where the daemon is, such as http://127.0.0.1:8080 or https://strew.example [default: where the settings say
    /// that it listens, over TLS if they say so]
    #[arg(long, value_name = "URL")]
    url: Option<String>,
    /// Ask whether it takes requests (/readyz). This is the default.
    #[arg(long, conflicts_with = "live")]
    ready: bool,
    /// Ask only whether it is alive (/livez).
    #[arg(long)]
    live: bool,
    /// The longest time for an answer, in seconds.
    #[arg(long, value_name = "SECONDS", default_value = "2")]
    timeout: f64,
    /// A PEM file with the authorities that issued the daemon's certificate, or with that certificate itself.
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "insecure",
        hide_short_help = true
    )]
    ca: Option<PathBuf>,
    /// The name that the daemon's certificate must have [default: the host of the URL]
    #[arg(long, value_name = "NAME", requires = "ca", hide_short_help = true)]
    server_name: Option<String>,
    /// Accept any certificate. Without --url the probe does so anyway: the daemon is on this machine, and no secret is
    /// sent.
    #[arg(long, hide_short_help = true)]
    insecure: bool,
    /// A PEM file with the client certificate for a daemon that requires one (tls.client_ca), and the
    /// certificates of its issuers.
    #[arg(long, value_name = "FILE", requires = "key", hide_short_help = true)]
    certificate: Option<PathBuf>,
    /// A PEM file with the private key of --certificate.
    #[arg(
        long,
        value_name = "FILE",
        requires = "certificate",
        hide_short_help = true
    )]
    key: Option<PathBuf>,
    #[command(flatten)]
    settings: config::Served,
}

/// Succeeds if the daemon answers with status 200.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    must_be_within("--timeout", args.timeout, [0.001, 3600.0])?;
    let timeout = Duration::from_secs_f64(args.timeout);
    let address = match &args.url {
        Some(url) => {
            args.settings.must_be_unused("--url has the address")?;
            address(url)?
        }
        None => {
            let settings = args.settings.merged()?;
            listener(settings.server.listen, settings.tls.is_on())?
        }
    };
    let tls = args.tls(&address).map_err(Failure::Usage)?;
    let (path, wanted) = match args.live {
        true => ("livez", "alive"),
        false => ("readyz", "ready"),
    };
    let url = format!("{address}{path}");
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .context("cannot start the runtime")?;
    let asked = async { tokio::time::timeout(timeout, status(&address, path, tls)).await };
    let answer = runtime.block_on(asked);
    // A name that is still being looked up must not keep the process.
    runtime.shutdown_background();
    let answer = match answer {
        Ok(answer) => answer.map_err(explained),
        Err(_) => Err(anyhow!("no answer within {timeout:?}")),
    };
    match answer.with_context(|| url.clone())?.as_u16() {
        200 => Ok(()),
        status => Err(anyhow!("{url}: not {wanted}: status {status}").into()),
    }
}

/// Reads the value of `--url`: a scheme, a host and perhaps a port, but neither a user nor a path.
fn address(url: &str) -> Result<Uri, Failure> {
    let read = || {
        let uri: Uri = url.parse().ok()?;
        let authority = uri.authority()?;
        let port = authority.as_str().strip_prefix(authority.host())?;
        let is_port = |text: &str| text.parse::<u16>().is_ok();
        let is_good = ["http", "https"].contains(&uri.scheme_str()?)
            && !authority.host().is_empty()
            && (port.is_empty() || port.strip_prefix(':').is_some_and(is_port))
            && uri.path_and_query()?.as_str() == "/";
        is_good.then_some(uri)
    };
    let Some(uri) = read() else {
        refuse!("--url {url}: allowed: http://host:port or https://host:port");
    };
    Ok(uri)
}

/// The address at which this machine reaches a daemon that listens there.
fn listener(listen: SocketAddr, is_tls: bool) -> Result<Uri, Failure> {
    if listen.port() == 0 {
        refuse!(
            "server.listen = {listen}: the port is only known to the daemon; name it with --url"
        );
    }
    let ip = match listen.ip() {
        IpAddr::V4(ip) if ip.is_unspecified() => [127, 0, 0, 1].into(),
        IpAddr::V6(ip) if ip.is_unspecified() => std::net::Ipv6Addr::LOCALHOST.into(),
        ip => ip,
    };
    let scheme = if is_tls { "https" } else { "http" };
    address(&format!(
        "{scheme}://{}",
        SocketAddr::new(ip, listen.port())
    ))
}

/// The settings of TLS, and the name that the daemon's certificate must have; `None` for plain HTTP.
type Tls = Option<(Arc<ClientConfig>, ServerName<'static>)>;

/// Requests a page of the daemon. Returns the status of the answer.
async fn status(address: &Uri, path: &str, tls: Tls) -> anyhow::Result<StatusCode> {
    let authority = address.authority().context("no host")?;
    let port = authority.port_u16();
    let port = port.unwrap_or(if tls.is_some() { 443 } else { 80 });
    let request = Request::get(format!("/{path}"))
        .header(HOST, authority.as_str())
        .header(CONNECTION, "close")
        .body(Empty::new())?;
    let socket = TcpStream::connect((host(address), port)).await?;
    match tls {
        None => answer(socket, request).await,
        Some((config, name)) => {
            let connector = TlsConnector::from(config);
            answer(connector.connect(name, socket).await?, request).await
        }
    }
}

async fn answer(
    stream: impl AsyncRead + AsyncWrite + Send + Unpin + 'static,
    request: Request<Empty<Bytes>>,
) -> anyhow::Result<StatusCode> {
    let (mut sender, connection) = http1::handshake(TokioIo::new(stream)).await?;
    tokio::spawn(connection);
    Ok(sender.send_request(request).await?.status())
}

/// The host of an address, without the brackets of IPv6.
fn host(address: &Uri) -> &str {
    let host = address.host().unwrap_or_default();
    host.trim_matches(['[', ']'])
}

fn explained(error: anyhow::Error) -> anyhow::Error {
    let of_http: Option<&hyper::Error> = error.downcast_ref();
    if of_http.is_some_and(hyper::Error::is_parse) {
        return anyhow!("the answer is not HTTP (a daemon with TLS needs https)");
    }
    let of_socket: Option<&io::Error> = error.chain().find_map(|cause| cause.downcast_ref());
    let is_end = of_socket.is_some_and(|error| error.kind() == io::ErrorKind::UnexpectedEof);
    if is_end || of_http.is_some_and(hyper::Error::is_incomplete_message) {
        return anyhow!("the connection ended before the answer was complete");
    }
    let of_tls = of_socket.and_then(|error| error.get_ref()?.downcast_ref());
    // TLS 1.3 has an alert for a missing certificate, TLS 1.2 has none.
    let wanted = rustls::Error::AlertReceived(AlertDescription::CertificateRequired);
    let text = of_socket.map_or_else(|| error.to_string(), ToString::to_string);
    match of_tls == Some(&wanted) {
        true => anyhow!(text)
            .context("the daemon requires a client certificate: use --certificate and --key"),
        false => anyhow!(text),
    }
}

impl Args {
    fn tls(&self, address: &Uri) -> anyhow::Result<Tls> {
        if address.scheme_str() == Some("http") {
            let flags = [
                ("--ca", self.ca.is_some()),
                ("--insecure", self.insecure),
                ("--certificate", self.certificate.is_some()),
            ];
            return match flags.into_iter().find(|(_, is_given)| *is_given) {
                Some((flag, _)) => {
                    bail!("{flag}: the URL is http; allowed: with an --url of https")
                }
                None => Ok(None),
            };
        }
        let verifier = match &self.ca {
            Some(path) => {
                Verifier::of(chain("--ca", path)?).map_err(|problem| of("--ca", path, &problem))?
            }
            None if self.insecure || self.url.is_none() => Verifier::of_anyone(),
            None => bail!("https needs --ca FILE, or --insecure to accept any certificate"),
        };
        let builder = ClientConfig::builder_with_provider(default_provider().into())
            .with_safe_default_protocol_versions()?
            .dangerous()
            .with_custom_certificate_verifier(Arc::new(verifier));
        let config = match (&self.certificate, &self.key) {
            (Some(certificate), Some(key)) => {
                let chain = chain("--certificate", certificate)?;
                let private = PrivateKeyDer::from_pem_slice(&read("--key", key)?)
                    .map_err(|_| of("--key", key, "it holds no private key in PEM"))?;
                let config = builder.with_client_auth_cert(chain, private);
                config.map_err(|error| {
                    let problem = format!("it does not go with --certificate: {error}");
                    of("--key", key, &problem)
                })?
            }
            _ => builder.with_no_client_auth(),
        };
        let (flag, name) = match &self.server_name {
            Some(name) => ("--server-name", &**name),
            None => ("--url", host(address)),
        };
        let name = ServerName::try_from(name.to_owned())
            .map_err(|_| anyhow!("{flag}: {name:?} is neither a host name nor an IP address"))?;
        Ok(Some((config.into(), name)))
    }
}

const MOST_BYTES: u64 = 4 << 20;

fn read(flag: &str, path: &Path) -> anyhow::Result<Vec<u8>> {
    bounded_file::read(path, MOST_BYTES)
        .with_context(|| format!("{flag} {}: it cannot be read", path.display()))
}

fn chain(flag: &str, path: &Path) -> anyhow::Result<Vec<CertificateDer<'static>>> {
    certificates(&read(flag, path)?).map_err(|problem| of(flag, path, &problem))
}

fn of(flag: &str, path: &Path, problem: &str) -> anyhow::Error {
    anyhow!("{flag} {}: {problem}", path.display())
}

/// Decides which certificates are accepted: with named ones those and the ones that they issued, else any. In either
/// case the daemon must have the certificate's key.
#[derive(Debug)]
struct Verifier {
    algorithms: WebPkiSupportedAlgorithms,
    trusted: Option<(Vec<CertificateDer<'static>>, Arc<WebPkiServerVerifier>)>,
}

impl Verifier {
    fn of_anyone() -> Self {
        Self {
            algorithms: default_provider().signature_verification_algorithms,
            trusted: None,
        }
    }

    fn of(named: Vec<CertificateDer<'static>>) -> Result<Self, String> {
        let mut roots = RootCertStore::empty();
        for authority in &named {
            let added = roots.add(authority.clone());
            added.map_err(|error| error.to_string())?;
        }
        let provider = Arc::new(default_provider());
        let chains = WebPkiServerVerifier::builder_with_provider(roots.into(), provider).build();
        let chains = chains.map_err(|error| error.to_string())?;
        Ok(Self {
            trusted: Some((named, chains)),
            ..Self::of_anyone()
        })
    }
}

impl ServerCertVerifier for Verifier {
    fn verify_server_cert(
        &self,
        shown: &CertificateDer<'_>,
        between: &[CertificateDer<'_>],
        name: &ServerName<'_>,
        stapled: &[u8],
        time: UnixTime,
    ) -> Result<ServerCertVerified, rustls::Error> {
        let Some((named, chains)) = &self.trusted else {
            return Ok(ServerCertVerified::assertion());
        };
        if !named.iter().any(|named| named == shown) {
            return chains.verify_server_cert(shown, between, name, stapled, time);
        }
        // `openssl req -x509` makes authorities, which webpki refuses as certificates of servers. This
        // very one is trusted, so only its name and its time are left to check.
        verify_server_name(&ParsedCertificate::try_from(shown)?, name)?;
        let bounds = validity(shown).ok_or(CertificateError::BadEncoding)?;
        let [not_before, not_after] = <[u64; 2]>::from(bounds)
            .map(|seconds| UnixTime::since_unix_epoch(Duration::from_secs(seconds)));
        if time < not_before {
            return Err(CertificateError::NotValidYetContext { time, not_before }.into());
        }
        if time > not_after {
            return Err(CertificateError::ExpiredContext { time, not_after }.into());
        }
        Ok(ServerCertVerified::assertion())
    }

    fn verify_tls12_signature(
        &self,
        message: &[u8],
        certificate: &CertificateDer<'_>,
        signed: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, rustls::Error> {
        verify_tls12_signature(message, certificate, signed, &self.algorithms)
    }

    fn verify_tls13_signature(
        &self,
        message: &[u8],
        certificate: &CertificateDer<'_>,
        signed: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, rustls::Error> {
        verify_tls13_signature(message, certificate, signed, &self.algorithms)
    }

    fn supported_verify_schemes(&self) -> Vec<SignatureScheme> {
        self.algorithms.supported_schemes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_url_is_a_scheme_a_host_and_a_port() {
        for url in [
            "http://127.0.0.1:8080",
            "http://[::1]:8080/",
            "http://strew",
            "https://strew:8443/",
        ] {
            let shown = address(url).expect(url).to_string();
            assert_eq!(shown, format!("{}/", url.trim_end_matches('/')));
        }
        for url in [
            "",
            "strew",
            "ftp://a:1",
            "http://",
            "http://:80",
            "http://a/readyz",
            "http://a/?b",
            "http://u@a",
            "http://u@a:80",
            "http://a:99999",
            "http://a b",
        ] {
            let Err(Failure::Usage(error)) = address(url) else {
                panic!("{url} is read");
            };
            let error = error.to_string();
            assert!(error.contains("allowed: http://host:port"), "{error}");
        }
    }

    #[test]
    fn a_daemon_that_listens_everywhere_is_reached_here() {
        let of = |text: &str, is_tls| listener(text.parse().expect("an address"), is_tls);
        for (text, is_tls, expected) in [
            ("0.0.0.0:80", false, "http://127.0.0.1:80/"),
            ("[::]:80", true, "https://[::1]:80/"),
            ("10.1.2.3:80", false, "http://10.1.2.3:80/"),
        ] {
            assert_eq!(of(text, is_tls).expect("a port").to_string(), expected);
        }
        assert!(of("127.0.0.1:0", false).is_err());
    }
}
