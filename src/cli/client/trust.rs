//! The TLS settings of `strew probe` and `--url`: trusted authorities, and the client certificate.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use anyhow::{Context as _, anyhow, bail};
use rustls::{
    ClientConfig,
    crypto::ring::default_provider,
    pki_types::{PrivateKeyDer, ServerName, pem::PemObject as _},
};
use strew_config::bounded_file;

use super::{address::Address, verifier::Verifier};
use crate::ops::tls::certificates;

/// Flags for a daemon that speaks TLS.
#[derive(Debug, clap::Args)]
pub(crate) struct TrustArgs {
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
    /// Accept any certificate. `strew probe` without --url does so anyway: the daemon is on this
    /// machine, and no secret is sent.
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
}

/// The TLS of a connection: the settings, and the name that the daemon's certificate must have.
#[derive(Debug)]
pub(crate) struct Tls {
    pub(super) config: Arc<ClientConfig>,
    pub(super) name: ServerName<'static>,
}

impl TrustArgs {
    /// Refuses these flags where they have no effect, for a reason.
    pub(crate) fn must_be_unused(&self, why: &str) -> anyhow::Result<()> {
        let given = [
            ("--ca", self.ca.is_some()),
            ("--insecure", self.insecure),
            ("--certificate", self.certificate.is_some()),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((flag, _)) => bail!("{flag}: {why}; allowed: with an --url of https"),
            None => Ok(()),
        }
    }

    /// The TLS for an address, `None` for http. With `is_trusted` any certificate is accepted.
    pub(crate) fn tls(&self, address: &Address, is_trusted: bool) -> anyhow::Result<Option<Tls>> {
        if !address.is_tls {
            self.must_be_unused("the URL is http")?;
            return Ok(None);
        }
        let verifier = match &self.ca {
            Some(path) => certificates(&read("--ca", path)?)
                .and_then(Verifier::of)
                .map_err(|problem| of("--ca", path, &problem))?,
            None if self.insecure || is_trusted => Verifier::of_anyone(),
            None => bail!("https needs --ca FILE, or --insecure to accept any certificate"),
        };
        let builder = ClientConfig::builder_with_provider(default_provider().into())
            .with_safe_default_protocol_versions()?
            .dangerous()
            .with_custom_certificate_verifier(Arc::new(verifier));
        let config = match (&self.certificate, &self.key) {
            (Some(certificate), Some(key)) => {
                let chain = certificates(&read("--certificate", certificate)?)
                    .map_err(|problem| of("--certificate", certificate, &problem))?;
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
            Some(name) => ("--server-name", name),
            None => ("--url", &address.host),
        };
        let name = ServerName::try_from(name.clone())
            .map_err(|_| anyhow!("{flag}: {name:?} is neither a host name nor an IP address"))?;
        let config = config.into();
        Ok(Some(Tls { config, name }))
    }
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
