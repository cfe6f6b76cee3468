//! What a client accepts: the format (RFC 9110, 12.5.1) and the coding (12.5.3) of an answer; and `Vary` (12.5.5), the
//! headers of requests that an answer depends on.

use http::{
    HeaderMap, HeaderName, HeaderValue,
    header::{ACCEPT, ACCEPT_ENCODING, Entry, VARY},
};
use strew_encode::Encoding;
use strew_error::Error;

pub(super) const BY_CODING: HeaderValue = HeaderValue::from_static("accept-encoding");
pub(super) const BY_ORIGIN: HeaderValue = HeaderValue::from_static("origin");
/// `Vary` of almost all answers with points; all answers get the second name.
pub(super) const BY_BOTH: HeaderValue = HeaderValue::from_static("accept, accept-encoding");

pub(super) fn vary(headers: &mut HeaderMap, name: HeaderValue) {
    let line = match headers.entry(VARY) {
        Entry::Vacant(line) => {
            line.insert(name);
            return;
        }
        Entry::Occupied(line) => line.into_mut(),
    };
    if *line == BY_BOTH && name == BY_CODING {
        return;
    }
    if let Ok(joined) = HeaderValue::from_bytes(&[line.as_bytes(), b", ", name.as_bytes()].concat())
    {
        *line = joined;
    }
}

/// A format and the content type to call it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Chosen {
    pub(super) encoding: Encoding,
    pub(super) content_type: &'static str,
}

impl Chosen {
    pub(super) const fn named(encoding: Encoding) -> Self {
        Self {
            encoding,
            content_type: encoding.content_type(),
        }
    }
}

/// The formats by media type, in the order of preference for clients that have none.
fn offers() -> impl DoubleEndedIterator<Item = (&'static str, Encoding)> {
    let all = Encoding::ALL.iter();
    all.flat_map(|of| of.accepted().iter().map(|media_type| (*media_type, *of)))
}

/// A format under the media type that a client accepts.
fn offered(media_type: &'static str, encoding: Encoding) -> Chosen {
    let own = Chosen::named(encoding);
    // The content type of the format may have parameters, too.
    match own.content_type.starts_with(media_type) {
        true => own,
        false => Chosen {
            encoding,
            content_type: media_type,
        },
    }
}

pub(super) fn content_types() -> Vec<&'static str> {
    let named = Encoding::ALL.iter().copied().map(Encoding::content_type);
    let mut types = vec![];
    let offered = offers().map(|(media_type, encoding)| offered(media_type, encoding).content_type);
    for content_type in offered.chain(named) {
        if !types.contains(&content_type) {
            types.push(content_type);
        }
    }
    types
}

/// The offer that the `Accept` headers of a request like best; JSON if there are none.
pub(super) fn accepted(headers: &HeaderMap) -> Result<Chosen, Error> {
    let accept = joined(headers, &ACCEPT);
    if accept.trim().is_empty() {
        return Ok(Chosen::named(Encoding::Json));
    }
    let ranges: Vec<Range<'_>> = accept.split(',').filter_map(Range::parse).collect();
    let wanted = offers().filter_map(|(media_type, encoding)| {
        let fitting = ranges.iter().filter(|range| range.holds(media_type));
        let closest = fitting.max_by_key(|range| range.precision())?;
        (closest.quality > 0).then_some((closest.quality, media_type, encoding))
    });
    // Of equals the first.
    let best = wanted.rev().max_by_key(|(quality, ..)| *quality);
    best.map(|(_, media_type, encoding)| offered(media_type, encoding))
        .ok_or_else(|| Error::NotAcceptable {
            accept: accept.chars().take(200).collect(),
            available: (offers().map(|(media_type, _)| media_type))
                .collect::<Vec<_>>()
                .join(", "),
        })
}

/// The lines of a header as one.
fn joined(headers: &HeaderMap, name: &HeaderName) -> String {
    let mut text = String::new();
    for line in headers.get_all(name) {
        if !text.is_empty() {
            text.push_str(", ");
        }
        text.push_str(&String::from_utf8_lossy(line.as_bytes()));
    }
    text
}

/// A media range with its quality in thousandths.
struct Range<'a> {
    main: &'a str,
    sub: &'a str,
    quality: u16,
}

impl<'a> Range<'a> {
    /// One element of the list; `None` if it is not a media range.
    fn parse(text: &'a str) -> Option<Self> {
        let (media_type, quality) = split(text)?;
        let (main, sub) = media_type.split_once('/')?;
        Some(Self { main, sub, quality })
    }

    fn holds(&self, media_type: &str) -> bool {
        let Some((main, sub)) = media_type.split_once('/') else {
            return false;
        };
        let like = |range: &str, part: &str| range == "*" || range.eq_ignore_ascii_case(part);
        like(self.main, main) && like(self.sub, sub)
    }

    /// The more precise range decides.
    fn precision(&self) -> u8 {
        u8::from(self.main != "*") + u8::from(self.sub != "*")
    }
}

/// An element without its parameters, and its quality in thousandths: 1000 unless it has a `q`.
/// `None` if a parameter is malformed.
fn split(element: &str) -> Option<(&str, u16)> {
    let mut parts = element.split(';').map(str::trim);
    let name = parts.next()?;
    let mut quality = 1000;
    for parameter in parts.filter(|part| !part.is_empty()) {
        let (name, value) = parameter.split_once('=')?;
        if name.trim().eq_ignore_ascii_case("q") {
            let value: f64 = value.trim().parse().ok()?;
            quality = (value.clamp(0.0, 1.0) * 1000.0).round() as u16;
        }
    }
    Some((name, quality))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coding {
    /// `zstd` (RFC 8878): smaller and several times as fast as gzip.
    Zstd,
    Gzip,
}

impl Coding {
    /// In the order of our preference.
    pub(super) const ALL: [Self; 2] = [Self::Zstd, Self::Gzip];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Zstd => "zstd",
            Self::Gzip => "gzip",
        }
    }

    /// About what a compressor holds, in bytes.
    pub(super) const fn memory(self) -> usize {
        match self {
            Self::Zstd => 1 << 20,
            Self::Gzip => 320 << 10,
        }
    }

    pub(super) fn chosen(headers: &HeaderMap, content_type: &str) -> Option<Self> {
        if !headers.contains_key(ACCEPT_ENCODING) || !is_text(content_type) {
            return None;
        }
        let mut text = joined(headers, &ACCEPT_ENCODING);
        text.make_ascii_lowercase();
        let accepted: Vec<(&str, u16)> = text.split(',').filter_map(accepted_coding).collect();
        let of = |name: &str| {
            let named = accepted.iter().find(|(other, _)| *other == name);
            named.map(|&(_, quality)| quality)
        };
        let any = of("*");
        // Plain is always possible, and preferred only by those who say so.
        let plain = of("identity").unwrap_or(0);
        let quality = |coding: Self| of(coding.name()).or(any).unwrap_or(0);
        let is_wanted = |coding: &Self| quality(*coding) > 0 && quality(*coding) >= plain;
        // Of equals the first.
        let all = Self::ALL.into_iter().rev().filter(is_wanted);
        all.max_by_key(|coding| quality(*coding))
    }
}

/// An element of the list: a coding with its quality in thousandths.
fn accepted_coding(element: &str) -> Option<(&str, u16)> {
    let (name, quality) = split(element)?;
    match name {
        "" => None,
        "x-gzip" => Some(("gzip", quality)),
        name => Some((name, quality)),
    }
}

/// Whether content of a type is text, which compresses well.
pub(super) fn is_text(content_type: &str) -> bool {
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
    use super::*;

    fn choose(accept: &str) -> Option<&'static str> {
        let mut headers = HeaderMap::new();
        headers.insert(ACCEPT, HeaderValue::from_str(accept).expect("printable"));
        accepted(&headers).ok().map(|chosen| chosen.content_type)
    }

    #[test]
    fn the_client_decides_and_json_is_the_default() {
        let json = Some("application/json");
        assert_eq!(
            accepted(&HeaderMap::new()).map(|c| c.encoding),
            Ok(Encoding::Json)
        );
        for (accept, expected) in [
            ("", json),
            ("*/*", json),
            ("application/*", json),
            ("text/html, */*;q=0.1", json),
            ("text/*", Some("text/csv; charset=utf-8; header=present")),
            (
                "Text/CSV;q=0.5, application/json;q=0.4",
                Some("text/csv; charset=utf-8; header=present"),
            ),
            ("application/x-ndjson", Some("application/x-ndjson")),
            (
                "application/vnd.strew.f32",
                Some("application/vnd.strew.f32"),
            ),
            (
                "application/vnd.strew.f64",
                Some("application/vnd.strew.f64"),
            ),
            (
                "application/json;q=0, */*;q=0.5",
                Some("application/x-ndjson"),
            ),
            ("text/html", None),
            ("application/json;q=0", None),
            ("nonsense", None),
        ] {
            assert_eq!(choose(accept), expected, "{accept}");
        }
    }

    #[test]
    fn the_quality_is_one_unless_it_is_given() {
        for (element, expected) in [
            (" gzip ", Some(("gzip", 1000))),
            ("gzip;q=0.5", Some(("gzip", 500))),
            ("gzip ; Q = 0.25 ", Some(("gzip", 250))),
            ("text/csv;header=present;q=2", Some(("text/csv", 1000))),
            ("gzip;", Some(("gzip", 1000))),
            ("gzip;q=x", None),
            ("gzip;q", None),
        ] {
            assert_eq!(split(element), expected, "{element}");
        }
    }

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
            headers.insert(ACCEPT_ENCODING, HeaderValue::from_static(accept));
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
