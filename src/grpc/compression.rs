//! Compression of answers to calls whose client requests it.
//!
//! Many libraries list gzip as accepted in every call, whether their user wants it or not, and
//! compressing a stream of points costs more than making it. So gzip goes out to those who send
//! gzip themselves, which is how libraries let a user ask (`compression=Gzip`, `UseCompressor`),
//! and zstd, which clients list only on purpose, to all that accept it.

use std::io::{self, Write as _};

use flate2::{Compression, write::GzEncoder};
use http::{HeaderMap, HeaderName, HeaderValue};
use strew_service::unpack::Coding;
use tonic::{Status, metadata::MetadataValue};

use super::status;

const ACCEPTED: HeaderName = HeaderName::from_static("grpc-accept-encoding");
pub(super) const SENT: HeaderName = HeaderName::from_static("grpc-encoding");

/// A coding as the protocol names it.
pub(super) const fn name(coding: Coding) -> &'static str {
    match coding {
        Coding::Gzip => "gzip",
        Coding::Zstd => "zstd",
    }
}

/// The coding that a call requests for its answer.
pub(super) fn asked(headers: &HeaderMap) -> Option<Coding> {
    let listed = headers.get(ACCEPTED)?.to_str().ok()?;
    let sends_gzip = || headers.get(SENT).is_some_and(|sent| sent == "gzip");
    listed.split(',').find_map(|listed| match listed.trim() {
        "zstd" => Some(Coding::Zstd),
        "gzip" if sends_gzip() => Some(Coding::Gzip),
        _ => None,
    })
}

/// The coding of the messages of a call, if they have one.
///
/// # Errors
/// UNIMPLEMENTED for one that is unknown here.
pub(super) fn sent(headers: &HeaderMap) -> Result<Option<Coding>, Status> {
    let unknown = match headers.get(SENT).map(HeaderValue::as_bytes) {
        None | Some(b"identity") => return Ok(None),
        Some(b"gzip") => return Ok(Some(Coding::Gzip)),
        Some(b"zstd") => return Ok(Some(Coding::Zstd)),
        Some(unknown) => status::cut(&String::from_utf8_lossy(unknown), 60),
    };
    let detail = format!("Content is compressed with `{unknown}` which isn't supported");
    let mut status = Status::unimplemented(detail);
    let known = MetadataValue::from_static("zstd,gzip,identity");
    status.metadata_mut().insert("grpc-accept-encoding", known);
    Err(status)
}

/// A message compressed, behind what is in a buffer already.
///
/// # Errors
/// As writing it; a buffer takes everything.
pub(super) fn pack(coding: Coding, buffer: Vec<u8>, message: &[u8]) -> io::Result<Vec<u8>> {
    match coding {
        Coding::Gzip => {
            let mut encoder = GzEncoder::new(buffer, Compression::default());
            encoder.write_all(message)?;
            encoder.finish()
        }
        Coding::Zstd => {
            let level = zstd::DEFAULT_COMPRESSION_LEVEL;
            let mut encoder = zstd::stream::write::Encoder::new(buffer, level)?;
            encoder.set_pledged_src_size(Some(message.len() as u64))?;
            encoder.write_all(message)?;
            encoder.finish()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gzip_must_be_asked_for_and_zstd_is() {
        for (accepted, sent, expected) in [
            ("identity, deflate, gzip", None, None),
            ("identity,deflate,gzip", Some("identity"), None),
            ("identity, deflate, gzip", Some("gzip"), Some("gzip")),
            ("gzip,zstd", None, Some("zstd")),
            ("gzip,zstd", Some("gzip"), Some("gzip")),
            ("zstd, gzip", Some("gzip"), Some("zstd")),
            ("", Some("gzip"), None),
        ] {
            let mut headers = HeaderMap::new();
            headers.insert(ACCEPTED, HeaderValue::from_static(accepted));
            if let Some(sent) = sent {
                headers.insert(SENT, HeaderValue::from_static(sent));
            }
            assert_eq!(asked(&headers).map(name), expected, "{accepted}, {sent:?}");
        }
    }
}
