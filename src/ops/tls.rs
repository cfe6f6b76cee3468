//! TLS: the server proves its identity with a certificate, and clients theirs if that is required.
//!
//! Certificates are read again by [`reload`](super::reload). New ones serve new connections; open
//! connections go on with those they began with.

mod expiry;

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use parking_lot::RwLock;
use rustls::{
    RootCertStore, ServerConfig,
    crypto::ring::default_provider,
    pki_types::{CertificateDer, PrivateKeyDer, pem::PemObject as _},
    server::{WebPkiClientVerifier, danger::ClientCertVerifier},
};
use tokio_rustls::TlsAcceptor;

pub use self::expiry::validity;
use strew_config::{Tls as Settings, bounded_file};

/// The fault of a certificate, or of a file of them.
#[derive(Debug, thiserror::Error)]
#[error("{setting} = {path:?}: {problem}")]
pub struct TlsError {
    setting: &'static str,
    path: PathBuf,
    problem: String,
}

impl TlsError {
    /// The file.
    pub(super) fn path(&self) -> String {
        self.path.display().to_string()
    }
}

/// Speaks TLS with what was read last.
#[derive(Clone)]
pub(super) struct Tls {
    settings: Settings,
    current: Arc<RwLock<Current>>,
}

struct Current {
    /// A hash of all files.
    content: blake3::Hash,
    config: Arc<ServerConfig>,
}

impl std::fmt::Debug for Tls {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Tls")
            .field("settings", &self.settings)
            .finish_non_exhaustive()
    }
}

impl Tls {
    /// Reads the files; `None` without TLS.
    pub(super) fn new(settings: &Settings) -> Result<Option<Self>, TlsError> {
        if !settings.is_on() {
            return Ok(None);
        }
        let files = Files::read(settings)?;
        let current = Current {
            content: files.hash(),
            config: files.config(settings)?,
        };
        Ok(Some(Self {
            settings: settings.clone(),
            current: Arc::new(RwLock::new(current)),
        }))
    }

    /// The acceptor of handshakes with the current certificate.
    pub(super) fn acceptor(&self) -> TlsAcceptor {
        let current = self.current.read();
        TlsAcceptor::from(current.config.clone())
    }

    /// Reads the files again; returns whether they have changed.
    ///
    /// # Errors
    /// If they cannot be used; then those before stay.
    pub(super) fn reload(&self) -> Result<bool, TlsError> {
        let files = Files::read(&self.settings)?;
        let content = files.hash();
        let known = self.current.read();
        if known.content == content {
            return Ok(false);
        }
        drop(known);
        let config = files.config(&self.settings)?;
        let mut current = self.current.write();
        *current = Current { content, config };
        Ok(true)
    }
}

/// The most bytes of a file of certificates.
const MAX_BYTES: u64 = 4 << 20;

/// The contents of all files.
struct Files {
    certificate: Vec<u8>,
    key: Vec<u8>,
    client_ca: Option<Vec<u8>>,
}

impl Files {
    fn read(settings: &Settings) -> Result<Self, TlsError> {
        let read = |setting, path: &Path| {
            let failed = |error: std::io::Error| TlsError {
                setting,
                path: path.into(),
                problem: format!("it cannot be read: {error}"),
            };
            bounded_file::read(path, MAX_BYTES).map_err(failed)
        };
        let client_ca = settings.proves_clients();
        let client_ca = client_ca.then(|| read("tls.client_ca", &settings.client_ca));
        Ok(Self {
            certificate: read("tls.certificate", &settings.certificate)?,
            key: read("tls.key", &settings.key)?,
            client_ca: client_ca.transpose()?,
        })
    }

    fn hash(&self) -> blake3::Hash {
        let mut hasher = blake3::Hasher::new();
        let client_ca = self.client_ca.as_deref().unwrap_or_default();
        for content in [&self.certificate, &self.key, client_ca] {
            hasher.update(&(content.len() as u64).to_le_bytes());
            hasher.update(content);
        }
        hasher.finalize()
    }

    fn config(&self, settings: &Settings) -> Result<Arc<ServerConfig>, TlsError> {
        let wrong = |setting, path: &Path, problem: String| TlsError {
            setting,
            path: path.into(),
            problem,
        };
        let of_certificate = |problem| wrong("tls.certificate", &settings.certificate, problem);
        let of_key = |problem| wrong("tls.key", &settings.key, problem);
        let of_clients = |problem| wrong("tls.client_ca", &settings.client_ca, problem);

        // Named, lest a second provider somewhere in the program make the choice ambiguous.
        let provider = Arc::new(default_provider());
        let chain = certificates(&self.certificate).map_err(of_certificate)?;
        for certificate in &chain {
            if let Some(warning) = expiry::warning(certificate) {
                tracing::warn!(path = %settings.certificate.display(), "{warning}");
            }
        }
        let key = PrivateKeyDer::from_pem_slice(&self.key)
            .map_err(|error| of_key(format!("it holds no private key in PEM: {error}")))?;
        let builder = ServerConfig::builder_with_provider(provider.clone())
            .with_safe_default_protocol_versions()
            .map_err(|error| of_certificate(error.to_string()))?;
        let builder = match &self.client_ca {
            None => builder.with_no_client_auth(),
            Some(pem) => {
                let mut roots = RootCertStore::empty();
                for authority in certificates(pem).map_err(of_clients)? {
                    let added = roots.add(authority);
                    added.map_err(|error| of_clients(error.to_string()))?;
                }
                let verifier: Arc<dyn ClientCertVerifier> =
                    WebPkiClientVerifier::builder_with_provider(Arc::new(roots), provider)
                        .build()
                        .map_err(|error| of_clients(error.to_string()))?;
                builder.with_client_cert_verifier(verifier)
            }
        };
        let mut config = builder
            .with_single_cert(chain, key)
            .map_err(|error| of_key(format!("it does not go with tls.certificate: {error}")))?;
        config.alpn_protocols = vec![b"h2".to_vec(), b"http/1.1".to_vec()];
        Ok(Arc::new(config))
    }
}

/// The certificates of a PEM file: at least one.
pub(crate) fn certificates(pem: &[u8]) -> Result<Vec<CertificateDer<'static>>, String> {
    let read: Result<Vec<_>, _> = CertificateDer::pem_slice_iter(pem).collect();
    let read = read.map_err(|error| format!("it is not PEM: {error}"))?;
    if read.is_empty() {
        return Err("it holds no certificate in PEM".into());
    }
    Ok(read)
}
