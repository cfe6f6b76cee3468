//! Which format a client accepts (RFC 9110, 12.5.1).

use http::{HeaderMap, header::ACCEPT};

use super::quality;
use crate::service::{Encoding, Error};

/// A format and the content type to call it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Chosen {
    pub(super) encoding: Encoding,
    pub(super) content_type: &'static str,
}

impl Chosen {
    /// A format that was asked for by name.
    pub(super) const fn named(encoding: Encoding) -> Self {
        Self {
            encoding,
            content_type: encoding.content_type(),
        }
    }
}

/// What is on offer by media type, in the order of preference where a client has none.
const OFFERS: [(&str, Chosen); 20] = [
    ("application/json", Chosen::named(Encoding::Json)),
    ("application/x-ndjson", Chosen::named(Encoding::Ndjson)),
    (
        "application/ndjson",
        Chosen {
            encoding: Encoding::Ndjson,
            content_type: "application/ndjson",
        },
    ),
    (
        "application/jsonl",
        Chosen {
            encoding: Encoding::Ndjson,
            content_type: "application/jsonl",
        },
    ),
    ("text/csv", Chosen::named(Encoding::Csv)),
    (
        "application/vnd.strew.f32",
        Chosen {
            encoding: Encoding::F32,
            content_type: "application/vnd.strew.f32",
        },
    ),
    (
        "application/vnd.strew.f64",
        Chosen {
            encoding: Encoding::F64,
            content_type: "application/vnd.strew.f64",
        },
    ),
    ("application/octet-stream", Chosen::named(Encoding::F64)),
    ("application/geo+json", Chosen::named(Encoding::Geojson)),
    (
        "application/geo+json-seq",
        Chosen::named(Encoding::Geojsonseq),
    ),
    (
        "application/vnd.apache.arrow.stream",
        Chosen::named(Encoding::Arrow),
    ),
    ("application/x-npy", Chosen::named(Encoding::Npy)),
    ("application/ply", Chosen::named(Encoding::Ply)),
    (
        "model/ply",
        Chosen {
            encoding: Encoding::Ply,
            content_type: "model/ply",
        },
    ),
    ("image/png", Chosen::named(Encoding::Png)),
    ("image/svg+xml", Chosen::named(Encoding::Svg)),
    ("model/gltf-binary", Chosen::named(Encoding::Glb)),
    ("model/vnd.usda", Chosen::named(Encoding::Usda)),
    (
        "application/vnd.strew.multimesh",
        Chosen {
            encoding: Encoding::Multimesh,
            content_type: "application/vnd.strew.multimesh",
        },
    ),
    (
        "application/vnd.strew.instances",
        Chosen {
            encoding: Encoding::Instances,
            content_type: "application/vnd.strew.instances",
        },
    ),
];

/// The content types that a client can be given, each once.
pub(super) fn content_types() -> Vec<&'static str> {
    let named = Encoding::ALL.map(Encoding::content_type);
    let mut types = vec![];
    for content_type in OFFERS
        .iter()
        .map(|(_, chosen)| chosen.content_type)
        .chain(named)
    {
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
        return Ok(OFFERS[0].1);
    }
    let ranges: Vec<Range<'_>> = accept.split(',').filter_map(Range::parse).collect();
    let mut best: Option<(u16, Chosen)> = None;
    for (media_type, chosen) in OFFERS {
        let closest = ranges
            .iter()
            .filter(|range| range.holds(media_type))
            .max_by_key(|range| range.precision());
        let Some(quality) = closest.map(|range| range.quality) else {
            continue;
        };
        if quality > best.map_or(0, |(quality, _)| quality) {
            best = Some((quality, chosen));
        }
    }
    best.map(|(_, chosen)| chosen)
        .ok_or_else(|| Error::NotAcceptable {
            accept: accept.chars().take(200).collect(),
            available: OFFERS.map(|(media_type, _)| media_type).join(", "),
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
