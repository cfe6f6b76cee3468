//! The coding that fits the client and the content of an answer.

use http::{HeaderMap, header};

use crate::rest::quality;

/// The coding that compresses an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::rest) enum Coding {
    /// `zstd` (RFC 8878): smaller and several times as fast as gzip.
    Zstd,
    /// `gzip` (RFC 1952).
    Gzip,
}

impl Coding {
    /// In the order of our preference.
    pub(in crate::rest) const ALL: [Self; 2] = [Self::Zstd, Self::Gzip];

    pub(in crate::rest) const fn name(self) -> &'static str {
        match self {
            Self::Zstd => "zstd",
            Self::Gzip => "gzip",
        }
    }

    /// The suffix that the tag of a compressed answer has.
    pub(in crate::rest) const fn suffix(self) -> &'static str {
        match self {
            Self::Zstd => "-zstd",
            Self::Gzip => "-gzip",
        }
    }

    /// About what a compressor holds, in bytes.
    pub(super) const fn memory(self) -> usize {
        match self {
            Self::Zstd => 1 << 20,
            Self::Gzip => 320 << 10,
        }
    }

    /// Whether any coding is for answers of a content type: text compresses well.
    pub(in crate::rest) fn is_for(content_type: &str) -> bool {
        is_text(content_type)
    }

    /// The coding of an answer of a content type to a request with these headers.
    pub(in crate::rest) fn chosen(headers: &HeaderMap, content_type: &str) -> Option<Self> {
        if !headers.contains_key(header::ACCEPT_ENCODING) || !Self::is_for(content_type) {
            return None;
        }
        let lines: Vec<String> = headers
            .get_all(header::ACCEPT_ENCODING)
            .iter()
            .map(|line| String::from_utf8_lossy(line.as_bytes()).to_ascii_lowercase())
            .collect();
        let accepted: Vec<(&str, u16)> = lines
            .iter()
            .flat_map(|line| line.split(','))
            .filter_map(accepted_coding)
            .collect();
        let of = |name: &str| {
            let named = accepted.iter().find(|(other, _)| *other == name);
            named.map(|&(_, quality)| quality)
        };
        let any = of("*");
        // Plain is always possible, and preferred only by those who say so.
        let plain = of("identity").unwrap_or(0);
        let best = Self::ALL
            .into_iter()
            .map(|coding| (coding, of(coding.name()).or(any).unwrap_or(0)))
            .filter(|&(_, quality)| quality > 0 && quality >= plain)
            // Of equals the first.
            .fold(None, |best: Option<(Self, u16)>, next| match best {
                Some(best) if best.1 >= next.1 => Some(best),
                _ => Some(next),
            });
        best.map(|(coding, _)| coding)
    }
}

/// An element of the list: a coding with its quality in thousandths.
fn accepted_coding(element: &str) -> Option<(&str, u16)> {
    let (name, quality) = quality::split(element)?;
    match name {
        "" => None,
        "x-gzip" => Some(("gzip", quality)),
        name => Some((name, quality)),
    }
}

/// Whether content of a type is text, which compresses well.
fn is_text(content_type: &str) -> bool {
    let media_type = content_type.split(';').next().unwrap_or_default().trim();
    let (_, sub) = media_type.split_once('/').unwrap_or_default();
    media_type.starts_with("text/")
        || ["json", "x-ndjson", "ndjson", "jsonl", "javascript"].contains(&sub)
        || ["+json", "+json-seq", "+xml"]
            .iter()
            .any(|end| sub.ends_with(end))
}

#[cfg(test)]
mod tests {
    use http::HeaderValue;

    use super::*;

    #[test]
    fn the_client_decides_and_zstd_comes_first() {
        let (zstd, gzip) = (Some(Coding::Zstd), Some(Coding::Gzip));
        for (accept, expected) in [
            ("", None),
            ("identity", None),
            ("br", None),
            ("gzip", gzip),
            ("x-gzip", gzip),
            ("GZIP;Q=0.5", gzip),
            ("zstd", zstd),
            ("gzip, deflate, br, zstd", zstd),
            ("gzip;q=1, zstd;q=0.5", gzip),
            ("zstd;q=0, gzip", gzip),
            ("*", zstd),
            ("zstd;q=0, *", gzip),
            ("*;q=0", None),
            ("gzip;q=0", None),
            ("identity;q=0.5, gzip;q=0.4", None),
            ("identity, gzip", gzip),
            ("gzip;quality=1", gzip),
        ] {
            let mut headers = HeaderMap::new();
            headers.insert(header::ACCEPT_ENCODING, HeaderValue::from_static(accept));
            assert_eq!(Coding::chosen(&headers, "text/csv"), expected, "{accept}");
            assert_eq!(Coding::chosen(&headers, "image/png"), None);
        }
    }

    #[test]
    fn text_is_text_and_nothing_else_is() {
        for text in [
            "text/csv; charset=utf-8",
            "application/json",
            "application/problem+json",
            "application/geo+json",
            "application/geo+json-seq",
            "application/x-ndjson",
            "image/svg+xml",
        ] {
            assert!(is_text(text), "{text}");
        }
        for other in [
            "application/octet-stream",
            "application/vnd.strew.f32",
            "application/vnd.apache.arrow.stream",
            "application/grpc",
            "image/png",
            "json",
            "",
        ] {
            assert!(!is_text(other), "{other}");
        }
    }
}
