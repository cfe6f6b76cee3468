//! Which format a client accepts (RFC 9110, 12.5.1).

use http::{HeaderMap, header::ACCEPT};
use strew_encode::Encoding;
use strew_error::Error;

use super::quality;

/// A format and the content type to call it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Chosen {
    pub(super) encoding: Encoding,
    pub(super) content_type: &'static str,
}

impl Chosen {
    /// A format that was requested by name.
    pub(super) const fn named(encoding: Encoding) -> Self {
        Self {
            encoding,
            content_type: encoding.content_type(),
        }
    }
}

/// The formats by media type, in the order of preference for clients that have none.
fn offers() -> impl Iterator<Item = (&'static str, Encoding)> {
    let of = |encoding: &Encoding| {
        let encoding = *encoding;
        encoding
            .accepted()
            .iter()
            .map(move |media_type| (*media_type, encoding))
    };
    Encoding::ALL.iter().flat_map(of)
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

/// The content types that a client can be given, each once.
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
    let lines: Vec<String> = headers
        .get_all(ACCEPT)
        .iter()
        .map(|value| String::from_utf8_lossy(value.as_bytes()).into_owned())
        .collect();
    let accept = lines.join(", ");
    if accept.trim().is_empty() {
        return Ok(Chosen::named(Encoding::Json));
    }
    let ranges: Vec<Range<'_>> = accept.split(',').filter_map(Range::parse).collect();
    let mut best: Option<(u16, Chosen)> = None;
    for (media_type, encoding) in offers() {
        let closest = ranges
            .iter()
            .filter(|range| range.holds(media_type))
            .max_by_key(|range| range.precision());
        let Some(quality) = closest.map(|range| range.quality) else {
            continue;
        };
        if quality > best.map_or(0, |(quality, _)| quality) {
            best = Some((quality, offered(media_type, encoding)));
        }
    }
    best.map(|(_, chosen)| chosen)
        .ok_or_else(|| Error::NotAcceptable {
            accept: accept.chars().take(200).collect(),
            available: (offers().map(|(media_type, _)| media_type))
                .collect::<Vec<_>>()
                .join(", "),
        })
}

/// A media range with its quality in thousandths.
#[derive(Debug)]
struct Range<'a> {
    main: &'a str,
    sub: &'a str,
    quality: u16,
}

impl<'a> Range<'a> {
    /// One element of the list; `None` if it is not a media range.
    fn parse(text: &'a str) -> Option<Self> {
        let (media_type, quality) = quality::split(text)?;
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

#[cfg(test)]
mod tests {
    use http::HeaderValue;

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
}
