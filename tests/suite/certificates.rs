//! Certificates made for a test, and a daemon that shows them.

use std::path::Path;

use rcgen::{
    BasicConstraints, CertificateParams, CertifiedIssuer, ExtendedKeyUsagePurpose, IsCa, KeyPair,
};
use rustls::pki_types::CertificateDer;

use crate::daemon::Daemon;

/// Someone who vouches for certificates.
pub struct Authority {
    issuer: CertifiedIssuer<'static, KeyPair>,
}

impl Authority {
    pub fn new() -> Self {
        let mut params = CertificateParams::default();
        params.is_ca = IsCa::Ca(BasicConstraints::Unconstrained);
        let key = KeyPair::generate().expect("a key");
        let issuer = CertifiedIssuer::self_signed(params, key).expect("signed");
        Self { issuer }
    }

    /// Its own certificate.
    pub fn certificate(&self) -> CertificateDer<'static> {
        self.issuer.der().clone()
    }

    /// The same as PEM.
    pub fn pem(&self) -> String {
        self.issuer.pem()
    }

    /// A certificate for a purpose and its key, as PEM and as bytes.
    pub fn issue(&self, purpose: ExtendedKeyUsagePurpose) -> Issued {
        let names = vec!["localhost".to_owned(), "127.0.0.1".to_owned()];
        let mut params = CertificateParams::new(names).expect("names");
        params.extended_key_usages = vec![purpose];
        let key = KeyPair::generate().expect("a key");
        let certificate = params.signed_by(&key, &self.issuer).expect("signed");
        Issued {
            pem: (certificate.pem(), key.serialize_pem()),
            certificate: certificate.der().clone(),
            key: key.serialize_der(),
        }
    }
}

/// A certificate with its key.
pub struct Issued {
    pub pem: (String, String),
    pub certificate: CertificateDer<'static>,
    pub key: Vec<u8>,
}

impl Issued {
    /// Makes it the server's in a folder.
    pub fn write(&self, folder: &Path) {
        std::fs::write(folder.join("server.pem"), &self.pem.0).expect("writable");
        std::fs::write(folder.join("server.key"), &self.pem.1).expect("writable");
    }
}

/// A daemon that speaks TLS with the files of a folder.
pub fn start(folder: &Path, more: &[&str]) -> Daemon {
    let file = |setting: &str, name: &str| format!("{setting}={}", folder.join(name).display());
    let mut settings = vec![
        file("tls.certificate", "server.pem"),
        file("tls.key", "server.key"),
    ];
    if folder.join("clients.pem").exists() {
        settings.push(file("tls.client_ca", "clients.pem"));
    }
    let mut all: Vec<&str> = settings.iter().map(String::as_str).collect();
    all.extend(more);
    Daemon::start(&all)
}
