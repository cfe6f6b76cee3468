//! TLS: the server proves its identity with a certificate, and clients theirs if that is required.
//!
//! Certificates are read again by [`reload`](super::reload). New ones serve new connections; open
//! connections go on with those they began with.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, SystemTime, UNIX_EPOCH},
};

use parking_lot::RwLock;
use rustls::{
    RootCertStore, ServerConfig,
    crypto::ring::default_provider,
    pki_types::{CertificateDer, PrivateKeyDer, pem::PemObject as _},
    server::{WebPkiClientVerifier, danger::ClientCertVerifier},
};
use strew_config::{Tls as Settings, bounded_file};
use tokio_rustls::TlsAcceptor;

#[derive(Debug, thiserror::Error)]
#[error("{setting} = {path:?}: {problem}")]
pub struct TlsError {
    setting: &'static str,
    path: PathBuf,
    problem: String,
}

impl TlsError {
    fn new(setting: &'static str, path: &Path, problem: String) -> Self {
        let path = path.into();
        Self {
            setting,
            path,
            problem,
        }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }
}

#[derive(Clone, Debug)]
pub(super) struct Tls {
    settings: Settings,
    current: Arc<RwLock<Current>>,
}

#[derive(Debug)]
struct Current {
    /// A hash of all files.
    content: blake3::Hash,
    config: Arc<ServerConfig>,
}

impl Tls {
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

    pub(super) fn acceptor(&self) -> TlsAcceptor {
        let current = self.current.read();
        TlsAcceptor::from(current.config.clone())
    }

    /// Reads the files again; returns whether they have changed.
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

const MAX_BYTES: u64 = 4 << 20;

struct Files {
    certificate: Vec<u8>,
    key: Vec<u8>,
    client_ca: Option<Vec<u8>>,
}

impl Files {
    fn read(settings: &Settings) -> Result<Self, TlsError> {
        let read = |setting, path: &Path| {
            let read = bounded_file::read(path, MAX_BYTES);
            read.map_err(|error| {
                TlsError::new(setting, path, format!("it cannot be read: {error}"))
            })
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
        let of_certificate =
            |problem| TlsError::new("tls.certificate", &settings.certificate, problem);
        let of_key = |problem| TlsError::new("tls.key", &settings.key, problem);
        let of_clients = |problem| TlsError::new("tls.client_ca", &settings.client_ca, problem);

        // Named, lest a second provider somewhere in the program make the choice ambiguous.
        let provider = Arc::new(default_provider());
        let chain = certificates(&self.certificate).map_err(of_certificate)?;
        for certificate in &chain {
            if let Some(warning) = warning(certificate) {
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

/// A certificate that expires sooner than this is worth a warning.
const SOON: u64 = 14 * DAY;
const DAY: u64 = 86_400;

fn warning(certificate: &[u8]) -> Option<String> {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let now = now.as_ref().map_or(0, Duration::as_secs);
    let (_, end) = validity(certificate)?;
    if end <= now {
        let days = (now - end) / DAY;
        return Some(format!("the certificate expired {days} days ago"));
    }
    let days = (end - now) / DAY;
    (end - now < SOON).then(|| format!("the certificate expires in {days} days"))
}

/// The first and the last second of a certificate in DER, counted from 1970.
pub fn validity(certificate: &[u8]) -> Option<(u64, u64)> {
    const SEQUENCE: u8 = 0x30;
    const VERSION: u8 = 0xA0;
    let (_, certificate, _) = element(certificate)?;
    let (_, mut fields, _) = element(certificate)?;
    if fields.first() == Some(&VERSION) {
        fields = element(fields)?.2;
    }
    // After the serial number, the algorithm and the issuer comes the validity.
    for _ in 0..3 {
        fields = element(fields)?.2;
    }
    let (tag, validity, _) = element(fields)?;
    (tag == SEQUENCE).then_some(())?;
    let (form, start, rest) = element(validity)?;
    let start = time(form, start)?;
    let (form, end, _) = element(rest)?;
    Some((start, time(form, end)?))
}

/// The first element of some DER: its tag, its content, and what follows it.
fn element(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let (&tag, rest) = bytes.split_first()?;
    let (&first, mut rest) = rest.split_first()?;
    let mut length = usize::from(first);
    if first & 0x80 != 0 {
        let digits;
        (digits, rest) = rest.split_at_checked(usize::from(first & 0x7F))?;
        let fold = |length: usize, &digit: &u8| length.checked_mul(256)?.checked_add(digit.into());
        length = digits.iter().try_fold(0, fold)?;
    }
    let (content, rest) = rest.split_at_checked(length)?;
    Some((tag, content, rest))
}

/// A time as `YYMMDDHHMMSSZ` or `YYYYMMDDHHMMSSZ`, by its tag.
fn time(form: u8, text: &[u8]) -> Option<u64> {
    const UTC_TIME: u8 = 0x17;
    let text = std::str::from_utf8(text).ok()?.strip_suffix('Z')?;
    let (year, rest) = text.split_at_checked(if form == UTC_TIME { 2 } else { 4 })?;
    let year: u64 = year.parse().ok()?;
    let year = match form == UTC_TIME {
        true if year < 50 => 2000 + year,
        true => 1900 + year,
        false => year,
    };
    let part = |i: usize| rest.get(2 * i..2 * i + 2)?.parse::<u64>().ok();
    let (month, day) = (part(0)?, part(1)?);
    let seconds = part(2)? * 3600 + part(3)? * 60 + part(4)?;
    // Days of the civil calendar, with years that begin in March.
    let (year, month) = if month > 2 {
        (year, month - 3)
    } else {
        (year.checked_sub(1)?, month + 9)
    };
    let days = year * 365 + year / 4 - year / 100 + year / 400 + (month * 153 + 2) / 5 + day;
    // 719,469 such days lie before 1970.
    Some(days.checked_sub(719_469)? * DAY + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_seconds_since_1970() {
        for (form, text, expected) in [
            (0x18, "19700101000000Z", 0),
            (0x18, "20000229123456Z", 951_827_696),
            (0x17, "491231235959Z", 2_524_607_999),
            (0x17, "991231235959Z", 946_684_799),
        ] {
            assert_eq!(time(form, text.as_bytes()), Some(expected), "{text}");
        }
        assert_eq!(time(0x17, b"nonsense"), None);
    }

    #[test]
    fn what_is_not_a_certificate_is_not_warned_about() {
        for bytes in [
            &b""[..],
            &[0x30],
            &[0x30, 0x84, 1],
            &[0x30, 0xFF],
            &[0x30; 100],
        ] {
            assert_eq!(warning(bytes), None);
        }
    }
}
