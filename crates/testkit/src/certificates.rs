//! Certificates made for a test.

use std::{
    path::Path,
    sync::atomic::{AtomicUsize, Ordering},
};

use rcgen::{
    BasicConstraints, CertificateParams, CertifiedIssuer, DnType, ExtendedKeyUsagePurpose, IsCa,
    KeyPair, date_time_ymd,
};

pub struct Authority {
    issuer: CertifiedIssuer<'static, KeyPair>,
}

impl Authority {
    /// An authority that nothing trusts yet, with a name of its own.
    #[expect(clippy::new_without_default, reason = "each one has another key")]
    pub fn new() -> Self {
        static NUMBER: AtomicUsize = AtomicUsize::new(1);
        let mut params = CertificateParams::default();
        // OpenSSL finds issuers by their names.
        let name = format!("authority {}", NUMBER.fetch_add(1, Ordering::Relaxed));
        params.distinguished_name.push(DnType::CommonName, name);
        params.is_ca = IsCa::Ca(BasicConstraints::Unconstrained);
        let key = KeyPair::generate().expect("a key");
        let issuer = CertifiedIssuer::self_signed(params, key).expect("signed");
        Self { issuer }
    }

    pub fn der(&self) -> Vec<u8> {
        self.issuer.der().to_vec()
    }

    pub fn pem(&self) -> String {
        self.issuer.pem()
    }

    /// Issues a server certificate for `localhost` and `127.0.0.1`.
    pub fn issue_server(&self) -> Certificate {
        self.issue(ExtendedKeyUsagePurpose::ServerAuth, 4000)
    }

    pub fn issue_expired_server(&self) -> Certificate {
        self.issue(ExtendedKeyUsagePurpose::ServerAuth, 2020)
    }

    pub fn issue_client(&self) -> Certificate {
        self.issue(ExtendedKeyUsagePurpose::ClientAuth, 4000)
    }

    /// A certificate that is valid to the beginning of a year.
    fn issue(&self, purpose: ExtendedKeyUsagePurpose, year: i32) -> Certificate {
        let mut params = CertificateParams::new(NAMES.map(String::from)).expect("names");
        params.extended_key_usages = vec![purpose];
        params.not_after = date_time_ymd(year, 1, 1);
        let key = KeyPair::generate().expect("a key");
        let certificate = params.signed_by(&key, &self.issuer).expect("signed");
        Certificate::new(&certificate, &key)
    }
}

/// A self-signed certificate for `localhost` and `127.0.0.1` that is an authority, as `openssl req -x509`
/// makes them, valid to the beginning of a year.
pub fn self_signed(year: i32) -> Certificate {
    let mut params = CertificateParams::new(NAMES.map(String::from)).expect("names");
    params.is_ca = IsCa::Ca(BasicConstraints::Unconstrained);
    params.not_after = date_time_ymd(year, 1, 1);
    let key = KeyPair::generate().expect("a key");
    Certificate::new(&params.self_signed(&key).expect("signed"), &key)
}

const NAMES: [&str; 2] = ["localhost", "127.0.0.1"];

/// A certificate with its key. The key is PKCS #8.
pub struct Certificate {
    pub pem: String,
    pub key_pem: String,
    pub der: Vec<u8>,
    pub key_der: Vec<u8>,
}

impl Certificate {
    fn new(certificate: &rcgen::Certificate, key: &KeyPair) -> Self {
        Self {
            pem: certificate.pem(),
            key_pem: key.serialize_pem(),
            der: certificate.der().to_vec(),
            key_der: key.serialize_der(),
        }
    }

    /// Writes the certificate and its key as `server.pem` and `server.key`.
    pub fn write_server(&self, folder: &Path) {
        std::fs::write(folder.join("server.pem"), &self.pem).expect("writable");
        std::fs::write(folder.join("server.key"), &self.key_pem).expect("writable");
    }
}
