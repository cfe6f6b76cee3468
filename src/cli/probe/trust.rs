//! How `strew probe` and `--url` speak TLS: which authorities are trusted, and the client certificate.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use anyhow::{Context as _, anyhow, bail};
use rustls::{
    ClientConfig,
    crypto::{CryptoProvider, ring::default_provider},
    pki_types::{PrivateKeyDer, ServerName, pem::PemObject as _},
};

use super::verifier::Verifier;
use crate::{bounded_file, ops::tls::certificates};

/// Flags for a daemon that speaks TLS.
#[derive(Debug, clap::Args)]
pub(in crate::cli) struct TrustArgs {
    /// A PEM file with the authorities that vouch for the daemon, or with its own certificate.
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "insecure",
        hide_short_help = true
    )]
    ca: Option<PathBuf>,
    /// The name that the daemon's certificate has to have. Default: the host of the URL.
    #[arg(long, value_name = "NAME", requires = "ca", hide_short_help = true)]
    server_name: Option<String>,
    /// Believe any certificate. `strew probe` does so without --url: what answers then is on this
    /// machine, and nothing secret is sent.
    #[arg(long, hide_short_help = true)]
    insecure: bool,
    /// A PEM file with the certificate to show to a daemon that asks for one (tls.client_ca), and
    /// those that vouch for it.
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
}

/// Why flags of TLS mean nothing for a URL of http.
pub(in crate::cli) const OVER_HTTP: &str = "the URL is http";

/// What a connection is made with.
#[derive(Debug)]
pub(in crate::cli) struct Trust {
    pub(in crate::cli) config: Arc<ClientConfig>,
    pub(in crate::cli) name: ServerName<'static>,
}

impl TrustArgs {
    /// Refuses flags that would mean nothing.
    pub(in crate::cli) fn must_be_unused(&self, problem: &str) -> anyhow::Result<()> {
        let given = [
            ("--ca", self.ca.is_some()),
            ("--insecure", self.insecure),
            ("--certificate", self.certificate.is_some()),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((flag, _)) => bail!("{flag}: {problem}; allowed: with an --url of https"),
            None => Ok(()),
        }
    }

    /// What to connect to `host` with; `is_here` if it is of this machine.
    pub(in crate::cli) fn trust(&self, host: &str, is_here: bool) -> anyhow::Result<Trust> {
        if self.ca.is_none() && !self.insecure && !is_here {
            bail!("https needs --ca FILE, or --insecure to believe any certificate");
        }
        let provider = Arc::new(default_provider());
        let builder = ClientConfig::builder_with_provider(provider.clone())
            .with_safe_default_protocol_versions()?;
        let verifier = match &self.ca {
            Some(path) => authorities(path, provider)?,
            None => Verifier::of_anyone(provider),
        };
        let builder = builder
            .dangerous()
            .with_custom_certificate_verifier(Arc::new(verifier));
        let mut config = match (&self.certificate, &self.key) {
            (Some(certificate), Some(key)) => {
                let chain = certificates(&read("--certificate", certificate)?)
                    .map_err(|problem| of("--certificate", certificate, &problem))?;
                let private = PrivateKeyDer::from_pem_slice(&read("--key", key)?)
                    .map_err(|_| of("--key", key, "it holds no private key in PEM"))?;
                builder
                    .with_client_auth_cert(chain, private)
                    .map_err(|error| {
                        of(
                            "--key",
                            key,
                            &format!("it does not go with --certificate: {error}"),
                        )
                    })?
            }
            _ => builder.with_no_client_auth(),
        };
        config.alpn_protocols = vec![b"http/1.1".to_vec()];
        let (flag, name) = match &self.server_name {
            Some(name) => ("--server-name", name.as_str()),
            None => ("--url", without_port(host)),
        };
        let name = ServerName::try_from(name.to_owned())
            .map_err(|_| anyhow!("{flag}: {name:?} is neither a name of a host nor an address"))?;
        Ok(Trust {
            config: Arc::new(config),
            name,
        })
    }
}

/// The host of `host:port`, without the brackets of IPv6.
fn without_port(host: &str) -> &str {
    let name = host.rsplit_once(':').map_or(host, |(name, _)| name);
    let inner = name
        .strip_prefix('[')
        .and_then(|name| name.strip_suffix(']'));
    inner.unwrap_or(name)
}

fn authorities(path: &Path, provider: Arc<CryptoProvider>) -> anyhow::Result<Verifier> {
    certificates(&read("--ca", path)?)
        .and_then(|named| Verifier::of(named, provider))
        .map_err(|problem| of("--ca", path, &problem))
}

/// The most bytes of a file with certificates or a key.
const MOST_BYTES: u64 = 4 << 20;

fn read(flag: &str, path: &Path) -> anyhow::Result<Vec<u8>> {
    bounded_file::read(path, MOST_BYTES)
        .with_context(|| format!("{flag} {}: it cannot be read", path.display()))
}

fn of(flag: &str, path: &Path, problem: &str) -> anyhow::Error {
    anyhow!("{flag} {}: {problem}", path.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_host_is_what_stands_before_its_port() {
        for (host, name) in [
            ("127.0.0.1:8080", "127.0.0.1"),
            ("[::1]:8080", "::1"),
            ("strew:443", "strew"),
        ] {
            assert_eq!(without_port(host), name);
        }
    }
}
