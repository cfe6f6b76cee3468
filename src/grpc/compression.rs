//! Compression of answers to calls whose client requests it.
//!
//! Many libraries list gzip as accepted in every call, whether their user wants it or not, and
//! compressing a stream of points costs more than making it. So gzip goes out to those who send
//! gzip themselves, which is how libraries let a user ask (`compression=Gzip`, `UseCompressor`),
//! and zstd, which clients list only on purpose, to all that accept it.

use http::{HeaderMap, HeaderName, HeaderValue};
use tonic::{codec::CompressionEncoding, metadata::MetadataMap};

/// The codings that are read and written.
pub(super) const COMPRESSIONS: [CompressionEncoding; 2] =
    [CompressionEncoding::Zstd, CompressionEncoding::Gzip];

const ACCEPTED: HeaderName = HeaderName::from_static("grpc-accept-encoding");
pub(super) const SENT: HeaderName = HeaderName::from_static("grpc-encoding");

/// Removes codings that a call accepts but does not request.
pub(super) fn settle(headers: &mut HeaderMap) {
    if !headers.contains_key(ACCEPTED) {
        return;
    }
    let text = |name| headers.get(name).and_then(|value| value.to_str().ok());
    let sends_gzip = text(SENT) == Some("gzip");
    let listed = text(ACCEPTED).unwrap_or_default();
    let asked: Vec<&str> = listed
        .split(',')
        .map(str::trim)
        .filter(|name| *name == "zstd" || *name == "gzip" && sends_gzip)
        .collect();
    match HeaderValue::from_str(&asked.join(",")) {
        Ok(value) if !asked.is_empty() => headers.insert(ACCEPTED, value),
        _ => headers.remove(ACCEPTED),
    };
}

/// Whether a settled call is answered compressed.
pub(super) fn is_asked(metadata: &MetadataMap) -> bool {
    metadata.contains_key(ACCEPTED.as_str())
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
            ("gzip,zstd", Some("gzip"), Some("gzip,zstd")),
            ("", Some("gzip"), None),
        ] {
            let mut headers = HeaderMap::new();
            headers.insert(ACCEPTED, HeaderValue::from_static(accepted));
            if let Some(sent) = sent {
                headers.insert(SENT, HeaderValue::from_static(sent));
            }
            settle(&mut headers);
            let left = headers
                .get(ACCEPTED)
                .map(|value| value.to_str().expect("text"));
            assert_eq!(left, expected, "{accepted}, {sent:?}");
        }
    }
}
