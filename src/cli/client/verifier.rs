//! Decides which certificates of daemons are accepted.

use std::{sync::Arc, time::Duration};

use rustls::{
    CertificateError, DigitallySignedStruct, Error, RootCertStore, SignatureScheme,
    client::{
        WebPkiServerVerifier,
        danger::{HandshakeSignatureValid, ServerCertVerified, ServerCertVerifier},
        verify_server_name,
    },
    crypto::{
        WebPkiSupportedAlgorithms, ring::default_provider, verify_tls12_signature,
        verify_tls13_signature,
    },
    pki_types::{CertificateDer, ServerName, UnixTime},
    server::ParsedCertificate,
};

use crate::ops::tls::validity;

/// Accepts certificates of some authorities, or any. In either case the daemon must have the
/// certificate's key.
#[derive(Debug)]
pub(super) struct Verifier {
    algorithms: WebPkiSupportedAlgorithms,
    trusted: Option<Trusted>,
}

/// Certificates of authorities, and of daemons that sign their certificates themselves.
#[derive(Debug)]
struct Trusted {
    named: Vec<CertificateDer<'static>>,
    chains: Arc<WebPkiServerVerifier>,
}

impl Verifier {
    /// Accepts any certificate.
    pub(super) fn of_anyone() -> Self {
        Self {
            algorithms: default_provider().signature_verification_algorithms,
            trusted: None,
        }
    }

    /// Accepts these certificates, and those that they issued.
    pub(super) fn of(named: Vec<CertificateDer<'static>>) -> Result<Self, String> {
        let mut roots = RootCertStore::empty();
        let chains = { named.iter().cloned() }
            .try_for_each(|authority| roots.add(authority))
            .map_err(|error| error.to_string())
            .and_then(|()| {
                let provider = Arc::new(default_provider());
                WebPkiServerVerifier::builder_with_provider(roots.into(), provider)
                    .build()
                    .map_err(|error| error.to_string())
            })?;
        Ok(Self {
            trusted: Some(Trusted { named, chains }),
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
        now: UnixTime,
    ) -> Result<ServerCertVerified, Error> {
        let Some(Trusted { named, chains }) = &self.trusted else {
            return Ok(ServerCertVerified::assertion());
        };
        if !named.iter().any(|named| named == shown) {
            return chains.verify_server_cert(shown, between, name, stapled, now);
        }
        // `openssl req -x509` makes authorities, which webpki refuses as certificates of servers. This
        // very one is trusted, so only its name and its time are left to check.
        verify_server_name(&ParsedCertificate::try_from(shown)?, name)?;
        let bounds = validity(shown).ok_or(CertificateError::BadEncoding)?;
        let [not_before, not_after] = <[u64; 2]>::from(bounds)
            .map(|seconds| UnixTime::since_unix_epoch(Duration::from_secs(seconds)));
        let time = now;
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
    ) -> Result<HandshakeSignatureValid, Error> {
        verify_tls12_signature(message, certificate, signed, &self.algorithms)
    }

    fn verify_tls13_signature(
        &self,
        message: &[u8],
        certificate: &CertificateDer<'_>,
        signed: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        verify_tls13_signature(message, certificate, signed, &self.algorithms)
    }

    fn supported_verify_schemes(&self) -> Vec<SignatureScheme> {
        self.algorithms.supported_schemes()
    }
}
