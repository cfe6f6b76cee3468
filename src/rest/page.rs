//! The daemon's own pages for people: `/`, a view of the plane, and what it leads to. Their parts are embedded and
//! served under `/page/`; they load nothing from elsewhere and use only the public API.
//!
//! The list of parts stands in [`PARTS`]; tests/tidy.rs holds it against the folder. The modules and the styles of a
//! page are joined at the start, because each request takes a round trip; the parts are served as well, for workers
//! and other pages.

use std::sync::Arc;

use axum::{Router, extract::State, response::Response, routing};
use bytes::Bytes;
use http::{HeaderMap, HeaderName, HeaderValue, Method, Uri, header};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    fixed::Fixed,
    joined::joined,
};
use crate::service::{
    Error, Kind,
    query::{Parameter, groups},
};

/// What the page may load: its own parts, and what the daemon answers. Nothing inline.
const POLICY: &str = "default-src 'none'; style-src 'self'; script-src 'self'; worker-src 'self'; \
                      connect-src 'self'; img-src 'self'; base-uri 'none'; form-action 'none'; \
                      frame-ancestors 'none'";

/// A page: its path, the name of its operation, a summary and a description of it, and its text.
type Page = (
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    &'static str,
);

/// The pages. The parts of the first are in `page/`, those of each other one in a folder of its own in there.
const PAGES: &[Page] = &[
    (
        "/",
        "getPage",
        "The page",
        "For people: a view of the plane, with controls for its points and the requests for them. Loads nothing from \
         elsewhere.",
        include_str!("page/index.html"),
    ),
    (
        "/docs",
        "getDocs",
        "The API as a page",
        "For people: every operation with its parameters and answers, and a form to try it. Loads nothing from \
         elsewhere.",
        include_str!("page/docs/index.html"),
    ),
    (
        "/compare",
        "getComparePage",
        "The page that compares ways to scatter points",
        "For people: six ways to scatter points side by side, with spectra, distances and times. Loads nothing from \
         elsewhere.",
        include_str!("page/compare/index.html"),
    ),
    (
        "/tile",
        "getTilePage",
        "The page of a tile",
        "For people: a texture of points or a mask for dithering that repeats without a seam, to look at and to save. \
         Loads nothing from elsewhere.",
        include_str!("page/tile/index.html"),
    ),
    (
        "/walk",
        "getWalk",
        "A walk through the plane, in three dimensions",
        "For people: a forest whose trees are points of the plane, streamed by chunk. Loads nothing from elsewhere.",
        include_str!("page/walk/index.html"),
    ),
];

macro_rules! parts {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("page/", $name)))),*]
    };
}

/// The parts of the page by their names.
const PARTS: &[(&str, &str)] = parts![
    "api.js",
    "bar.css",
    "bar.js",
    "card.js",
    "charts.js",
    "chunks.js",
    "commands.js",
    "compare/bridson.js",
    "compare/cells.js",
    "compare/compare.css",
    "compare/compare.js",
    "compare/halton.js",
    "compare/hash.js",
    "compare/joint.js",
    "compare/made.js",
    "compare/methods.js",
    "compare/panel.js",
    "compare/sheet.js",
    "compare/sources.js",
    "compare/tile.js",
    "compare/worker.js",
    "controls.js",
    "digits.js",
    "docs/attempt.js",
    "docs/docs.css",
    "docs/docs.js",
    "docs/operation.js",
    "docs/schema.js",
    "dom.js",
    "dots.js",
    "download.js",
    "faults.js",
    "fft.js",
    "form.css",
    "form.js",
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
    "paint/brush.js",
    "paint/message.js",
    "paint/paint.css",
    "paint/paint.js",
    "paint/strokes.js",
    "paint/world.js",
    "painter_2d.js",
    "painter_gl.js",
    "panel.css",
    "picture.js",
    "place.js",
    "plane.js",
    "profiles.js",
    "program.js",
    "query.js",
    "sent.js",
    "session.js",
    "shade.js",
    "sheets.js",
    "spectrum.js",
    "start.css",
    "start.js",
    "state.js",
    "status.js",
    "take.js",
    "theme.css",
    "theme.js",
    "tile/mask.js",
    "tile/period.js",
    "tile/state.js",
    "tile/tile.css",
    "tile/tile.js",
    "understand.js",
    "worker.js",
    "walk/camera.js",
    "walk/ground.js",
    "walk/land.js",
    "walk/leaves.js",
    "walk/map.js",
    "walk/move.js",
    "walk/scene.js",
    "walk/shaders.js",
    "walk/shapes.js",
    "walk/walk.css",
    "walk/walk.js",
    "walk/world.js",
    "works/works.css",
    "works/works.js",
    "works/draw.js",
    "works/modes.js",
    "works/pattern.js",
    "works/settings.js",
];

/// What is before the address of the picture that a passed-on link to a page shows.
const PREVIEW: &str = "<meta property=\"og:image\" content=\"";

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

/// The pages and their parts. `public_url` is where they are seen from outside, or empty.
pub(super) fn endpoints(public_url: &str) -> Vec<Endpoint> {
    let parts = PARTS.iter().map(|&(name, text)| {
        let content = Bytes::from_static(text.as_bytes());
        (name.to_owned(), Fixed::new(content_type(name), content))
    });
    let mut parts: Vec<(String, Fixed)> = parts.collect();
    let mut all: Vec<_> = PAGES
        .iter()
        .map(|one| page(one, public_url, &mut parts))
        .collect();
    let parts: Parts = Arc::new(parts);
    let of_the_first = ("/page/{file}", "getPagePart", "/page/main.js");
    all.push(parts_at(of_the_first, &[&FILE], &parts));
    let of_a_folder = (
        "/page/{folder}/{file}",
        "getPagePartIn",
        "/page/works/works.js",
    );
    all.push(parts_at(of_a_folder, &[&FOLDER, &FILE], &parts));
    all
}

/// The icon at the address where browsers look for that of an answer that is no page.
pub(super) fn icon() -> Router {
    let text = PARTS.iter().find(|(name, _)| *name == "icon.svg");
    let content = text.map_or(Bytes::new(), |(_, text)| {
        Bytes::from_static(text.as_bytes())
    });
    let icon = Fixed::new(PICTURE, content);
    let answer = move |uri: Uri, headers: HeaderMap| async move { part(&icon, &uri, &headers) };
    Router::new().route("/favicon.ico", routing::get(answer))
}

/// The name of the joined parts of a page.
fn name_of(path: &str) -> &str {
    match path.trim_matches('/') {
        "" => "page",
        name => name,
    }
}

/// A page, whose joined parts are added to the others.
fn page(
    &(path, id, summary, about, text): &Page,
    public_url: &str,
    parts: &mut Vec<(String, Fixed)>,
) -> Endpoint {
    let operation = operation((id, path, summary, about), &[HTML], &[], vec![]);
    let mut html = text.to_owned();
    // A test joins every page; one that could not be joined would work as it is.
    if let Ok(joined) = joined(name_of(path), text, PARTS) {
        html = joined.html;
        for (ending, text) in [("js", joined.script), ("css", joined.style)] {
            let name = format!("joined/{}.{ending}", name_of(path));
            let document = Fixed::new(content_type(&name), text.into());
            parts.push((name, document));
        }
    }
    let version = concat!(
        "<span id=\"version\">",
        env!("CARGO_PKG_VERSION"),
        "</span>"
    );
    let html = html.replace("<span id=\"version\"></span>", version);
    let html = html.replace(PREVIEW, &format!("{PREVIEW}{public_url}"));
    let document = Fixed::new(HTML, html.into());
    let handler =
        routing::get(
            move |uri: Uri, headers: HeaderMap| async move { part(&document, &uri, &headers) },
        );
    Endpoint::new(path, (), vec![(operation, handler)]).open()
}

/// Parts at a path, with the name of the operation and an example.
fn parts_at(
    (path, id, example): (&'static str, &'static str, &str),
    parameters: &'static [&'static Parameter],
    parts: &Parts,
) -> Endpoint {
    let operation = operation(
        (
            id,
            example,
            "A part of a page",
            "A script, a style or a picture that the pages load.",
        ),
        &[SCRIPT, STYLE, PICTURE],
        parameters,
        vec![Kind::NoSuchPath],
    );
    Endpoint::new(path, parts.clone(), vec![(operation, routing::get(one))]).open()
}

const FOLDER: Parameter = Parameter {
    name: "folder",
    about: "What the part belongs to.",
    allowed: Some("the name of a folder of parts"),
    example: "works",
    is_required: true,
    ..Parameter::PLAIN
};

const FILE: Parameter = Parameter {
    name: "file",
    about: "The name of the part.",
    allowed: Some("the name of a part"),
    example: "main.js",
    is_required: true,
    ..Parameter::PLAIN
};

fn operation(
    (id, example, summary, about): (&'static str, &str, &'static str, &'static str),
    content_types: &[&'static str],
    path_parameters: &'static [&'static Parameter],
    problems: Vec<Kind>,
) -> Operation {
    let text = |name: &&'static str| (*name, schemas::text as schemas::Content);
    Operation {
        method: Method::GET,
        id,
        summary,
        about,
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
type Parts = Arc<Vec<(String, Fixed)>>;

async fn one(State(parts): State<Parts>, uri: Uri, headers: HeaderMap) -> Result<Response, Error> {
    let name = uri.path().trim_start_matches("/page/");
    let found = parts.iter().find(|(part, _)| part == name);
    let (_, document) = found.ok_or_else(|| Error::NoSuchPath {
        path: uri.path().into(),
        available: "the pages and the parts that they name".into(),
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
    fn every_page_is_joined() {
        for &(path, .., text) in PAGES {
            let joined = joined(name_of(path), text, PARTS).expect("known forms");
            assert_eq!(joined.html.matches("/page/joined/").count(), 2, "{path}");
            for form in ["\nimport {", "\nexport ", "import(\"."] {
                assert!(!joined.script.contains(form), "{path} has {form}");
            }
        }
    }

    #[test]
    fn nothing_is_inline_and_nothing_comes_from_elsewhere() {
        let pages = PAGES.iter().map(|&(path, .., text)| (path, text));
        for (name, text) in PARTS.iter().copied().chain(pages) {
            // Links that people follow load nothing.
            let text = text.replace("<a href=\"https://", "<a href=\"");
            for word in ["style=\"", "innerHTML", "eval(", "onclick=\"", "https://"] {
                assert!(!text.contains(word), "{name} has {word}");
            }
        }
        for (.., text) in PAGES {
            assert!(!text.contains("<style") && !text.contains("<script>"));
        }
    }
}
