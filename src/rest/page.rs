//! `/`: the daemon's own page for people, a view of the plane. Its parts are embedded and served
//! under `/page/`; it loads nothing from elsewhere and asks only what anybody can ask.
//!
//! The list of parts stands in [`PARTS`]; tests/tidy.rs holds it against the folder.

use std::sync::Arc;

use axum::{
    extract::{Path, State},
    response::Response,
    routing,
};
use bytes::Bytes;
use http::{HeaderMap, HeaderName, HeaderValue, Method, Uri, header};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    fixed::Fixed,
};
use crate::service::{
    Error, Kind,
    query::{Parameter, groups},
};

/// What the page may load: its own parts, and what the daemon answers. Nothing inline.
const POLICY: &str = "default-src 'none'; style-src 'self'; script-src 'self'; worker-src 'self'; \
                      connect-src 'self'; img-src 'self'; base-uri 'none'; form-action 'none'; \
                      frame-ancestors 'none'";

/// The page itself.
const PAGE: &str = include_str!("page/index.html");

macro_rules! parts {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("page/", $name)))),*]
    };
}

/// The parts of the page by their names.
const PARTS: &[(&str, &str)] = parts![
    "api.js",
    "card.js",
    "charts.js",
    "chunks.js",
    "commands.js",
    "controls.js",
    "dom.js",
    "dots.js",
    "download.js",
    "fft.js",
    "gallery.css",
    "gallery.js",
    "gestures.js",
    "grid.js",
    "icon.svg",
    "layout.css",
    "main.js",
    "marks.js",
    "measure.js",
    "measure_worker.js",
    "neighbors.js",
    "painter_2d.js",
    "painter_gl.js",
    "panel.css",
    "picture.js",
    "place.js",
    "plane.js",
    "query.js",
    "session.js",
    "shade.js",
    "sheets.js",
    "spectrum.js",
    "state.js",
    "status.js",
    "take.js",
    "theme.css",
    "theme.js",
    "understand.js",
    "works.css",
    "works.js",
    "works_draw.js",
    "works_modes.js",
    "works_pattern.js",
    "works_settings.js",
];

const HTML: &str = "text/html; charset=utf-8";
const SCRIPT: &str = "text/javascript";
const STYLE: &str = "text/css";
const PICTURE: &str = "image/svg+xml";

/// The content type of a part.
fn content_type(name: &str) -> &'static str {
    match name.rsplit_once('.') {
        Some((_, "js")) => SCRIPT,
        Some((_, "css")) => STYLE,
        Some((_, "svg")) => PICTURE,
        _ => HTML,
    }
}

/// The page and its parts.
pub(super) fn endpoints() -> Vec<Endpoint> {
    let page = operation("getPage", "/", "The page", &[HTML], &[], vec![]);
    let document = Fixed::new(HTML, Bytes::from_static(PAGE.as_bytes()));
    let page_handler =
        routing::get(
            move |uri: Uri, headers: HeaderMap| async move { part(&document, &uri, &headers) },
        );
    let parts = operation(
        "getPagePart",
        "/page/main.js",
        "A part of the page",
        &[SCRIPT, STYLE, PICTURE],
        &[&FILE],
        vec![Kind::NoSuchPath],
    );
    let parts_handler = routing::get(one);
    let all = PARTS.iter().map(|&(name, text)| {
        let content = Bytes::from_static(text.as_bytes());
        (name, Fixed::new(content_type(name), content))
    });
    let all: Parts = Arc::new(all.collect());
    vec![
        Endpoint::new("/", (), vec![(page, page_handler)]).open(),
        Endpoint::new("/page/{file}", all, vec![(parts, parts_handler)]).open(),
    ]
}

const FILE: Parameter = Parameter {
    name: "file",
    about: "The name of the part.",
    allowed: Some("the name of a part"),
    example: "main.js",
    is_required: true,
    ..Parameter::PLAIN
};

fn operation(
    id: &'static str,
    example: &str,
    summary: &'static str,
    content_types: &[&'static str],
    path_parameters: &'static [&'static Parameter],
    problems: Vec<Kind>,
) -> Operation {
    let text = |name: &&'static str| (*name, schemas::text as schemas::Content);
    Operation {
        method: Method::GET,
        id,
        summary,
        about: "For people: a view of the plane. Loads nothing from elsewhere.",
        tag: Tag::About,
        path_parameters,
        parameters: groups::NONE,
        body: None,
        answers: vec![
            api::Answer {
                status: 200,
                about: summary,
                headers: vec![],
                contents: content_types.iter().map(text).collect(),
            },
            api::Answer::unchanged(),
        ],
        problems,
        example: example.into(),
    }
}

/// The parts by their names, ready to send.
type Parts = Arc<Vec<(&'static str, Fixed)>>;

async fn one(
    State(parts): State<Parts>,
    Path(file): Path<String>,
    uri: Uri,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let found = parts.iter().find(|(name, _)| *name == file);
    let (_, document) = found.ok_or_else(|| Error::NoSuchPath {
        path: uri.path().into(),
        available: "/ and the parts that it names".into(),
    })?;
    Ok(part(document, &uri, &headers))
}

fn part(document: &Fixed, uri: &Uri, headers: &HeaderMap) -> Response {
    let mut response = document.answer(uri, headers);
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (CROSS_ORIGIN_OPENER_POLICY, "same-origin"),
        // Parts of different versions do not fit together, so each load asks whether all are still
        // right; their tags make that cheap.
        (header::CACHE_CONTROL, "no-cache"),
    ] {
        let value = HeaderValue::from_static(value);
        response.headers_mut().insert(name, value);
    }
    response
}

const CROSS_ORIGIN_OPENER_POLICY: HeaderName =
    HeaderName::from_static("cross-origin-opener-policy");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_inline_and_nothing_comes_from_elsewhere() {
        let all = PARTS.iter().chain(&[("index.html", PAGE)]);
        for (name, text) in all {
            for word in ["style=\"", "innerHTML", "eval(", "onclick=\"", "https://"] {
                assert!(!text.contains(word), "{name} has {word}");
            }
        }
        assert!(!PAGE.contains("<style") && !PAGE.contains("<script>"));
    }
}
