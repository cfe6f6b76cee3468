//! The daemon's own pages for people: `/`, a view of the plane, and the pages that it leads to. Their parts are served
//! under `/page/`; they load nothing from elsewhere and use only the public API.
//!
//! The program hands them in, because an edit of a page then compiles nothing of this crate.

use std::sync::Arc;

use axum::extract::State;
use bytes::Bytes;
use http::{HeaderName, HeaderValue, header};
use strew_error::{Error, Kind};
use strew_query::Parameter;

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    context::{Answered, Context},
    document::{Fixed, JSON},
    negotiate::Coding,
};

/// The policy of pages: they may load their own parts and the answers of the daemon, and nothing inline.
const POLICY: &str = "default-src 'none'; style-src 'self'; script-src 'self'; worker-src 'self'; \
                      connect-src 'self'; img-src 'self'; base-uri 'none'; form-action 'none'; \
                      frame-src 'self'; frame-ancestors 'self'";

#[derive(Clone, Debug, Default)]
pub struct Pages {
    pub pages: Vec<Page>,
    pub parts: Vec<Part>,
}

/// A script, a style or a picture.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Its name below `/page/`, such as `docs/docs.css`.
    pub name: &'static str,
    pub plain: &'static [u8],
    /// Its content, compressed by `zstd`; empty for a picture of pixels, as is `gzip`.
    pub zstd: &'static [u8],
    pub gzip: &'static [u8],
}

#[derive(Clone, Debug)]
pub struct Page {
    pub path: &'static str,
    pub id: &'static str,
    pub summary: &'static str,
    pub about: &'static str,
    pub html: &'static str,
}

/// The markup before the address of the picture that previews of links to a page show.
const PREVIEW: &str = "<meta property=\"og:image\" content=\"";
/// The attributes of the lines about the preview picture, by which a page without an address for it leaves them out.
const ABOUT_PREVIEW: [&str; 2] = ["property=\"og:image", "name=\"twitter:card\""];

const HTML: &str = "text/html; charset=utf-8";
const SCRIPT: &str = "text/javascript";
const STYLE: &str = "text/css";
const DRAWING: &str = "image/svg+xml";
const PICTURE: &str = "image/jpeg";

impl Part {
    fn document(&self) -> Arc<Fixed> {
        let coded = [(Coding::Zstd, self.zstd), (Coding::Gzip, self.gzip)];
        let coded = coded.into_iter().filter(|(_, content)| !content.is_empty());
        Fixed::coded(
            content_type(self.name),
            Bytes::from_static(self.plain),
            coded.map(|(coding, content)| (coding, Bytes::from_static(content))),
        )
    }
}

fn content_type(name: &str) -> &'static str {
    match name.rsplit_once('.') {
        Some((_, "js")) => SCRIPT,
        Some((_, "css")) => STYLE,
        Some((_, "svg")) => DRAWING,
        Some((_, "jpg")) => PICTURE,
        _ => HTML,
    }
}

/// The endpoints of pages and their parts. `public_url` is where they are seen from outside, or empty.
pub(super) fn endpoints(pages: &Pages, public_url: &str) -> Vec<Endpoint> {
    let parts = pages.parts.iter().map(|part| (part.name, part.document()));
    let parts: Parts = Arc::new(parts.collect());
    let mut all: Vec<_> = (pages.pages.iter())
        .map(|one| page(one, public_url))
        .collect();
    let (path, example) = ("/page/{file}", "/page/main.js");
    all.push(parts_at(path, "getPagePart", example, &[&FILE], &parts));
    let (path, example) = ("/page/{folder}/{file}", "/page/walk/walk.js");
    let within = &[&FOLDER, &FILE];
    all.push(parts_at(path, "getPagePartIn", example, within, &parts));
    all
}

/// The icon at the address where browsers look for that of an answer that is no page.
pub(super) fn icon(pages: &Pages) -> Option<Endpoint> {
    let mut parts = pages.parts.iter();
    let icon = parts.find(|part| part.name == "icon.svg")?.document();
    let described = ("getIcon", "/favicon.ico", "The icon", "");
    let operation = operation(described, &[DRAWING], &[], vec![]);
    Some(Endpoint::only("/favicon.ico", icon, operation, fixed).open())
}

fn page(page: &Page, public_url: &str) -> Endpoint {
    let described = (page.id, page.path, page.summary, page.about);
    let operation = operation(described, &[HTML], &[], vec![]);
    let version = concat!(
        "<span id=\"version\">",
        env!("CARGO_PKG_VERSION"),
        "</span>"
    );
    let html = page.html.replace("<span id=\"version\"></span>", version);
    let html = previewed(&html, public_url);
    let document = Fixed::new(HTML, html.into());
    Endpoint::only(page.path, document, operation, fixed).open()
}

/// A page whose preview has an absolute address. Readers drop relative ones, and a name that the client sends is none
/// to vouch for: without a public address the page names no picture.
fn previewed(html: &str, public_url: &str) -> String {
    if !public_url.is_empty() {
        return html.replace(PREVIEW, &format!("{PREVIEW}{public_url}"));
    }
    let lines = html.split_inclusive('\n');
    lines
        .filter(|line| !ABOUT_PREVIEW.iter().any(|words| line.contains(words)))
        .collect()
}

fn parts_at(
    path: &'static str,
    id: &'static str,
    example: &str,
    parameters: &'static [&'static Parameter],
    parts: &Parts,
) -> Endpoint {
    let about = "A script, a style or a picture that the pages load.";
    let described = (id, example, "A part of a page", about);
    let types = [SCRIPT, STYLE, DRAWING, PICTURE];
    let operation = operation(described, &types, parameters, vec![Kind::NoSuchPath]);
    Endpoint::only(path, parts.clone(), operation, one).open()
}

const FOLDER: Parameter = Parameter {
    name: "folder",
    about: "The folder of the part.",
    allowed: Some("the name of a folder of parts"),
    example: "works",
    ..FILE
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
    let text = |name: &&'static str| {
        let is_text = *name != PICTURE;
        let content = if is_text { schemas::text } else { schemas::any };
        (*name, content as schemas::Content)
    };
    let answer = api::Answer {
        status: 200,
        about: summary,
        headers: vec![],
        contents: content_types.iter().map(text).collect(),
    };
    Operation {
        id,
        summary,
        about,
        path_parameters,
        problems,
        example: example.into(),
        ..Operation::new(Tag::About, answer.or_unchanged())
    }
}

type Parts = Arc<Vec<(&'static str, Arc<Fixed>)>>;

async fn one(State(parts): State<Parts>, context: Context) -> Answered {
    let name = context.uri.path().trim_start_matches("/page/");
    let found = parts.iter().find(|(part, _)| *part == name);
    let (_, document) = found.ok_or_else(|| Error::NoSuchPath {
        path: context.uri.path().into(),
        available: "the pages and the parts that they name".into(),
    })?;
    fixed(State(document.clone()), context).await
}

async fn fixed(State(document): State<Arc<Fixed>>, context: Context) -> Answered {
    let mut response = document.answer(&context.uri, &context.headers);
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
    Ok(response)
}

const CROSS_ORIGIN_OPENER_POLICY: HeaderName =
    HeaderName::from_static("cross-origin-opener-policy");

pub(super) fn description(endpoints: &[Endpoint]) -> Endpoint {
    let answers = api::Answer::file("The document.", JSON, schemas::object).or_unchanged();
    let operation = Operation {
        id: "getOpenapi",
        summary: "This document",
        about: "OpenAPI 3.1. The page /docs shows it.",
        problems: vec![],
        ..Operation::new(Tag::About, answers)
    };
    let answer = async |State(document): State<Arc<Fixed>>, context: Context| {
        document.answer(&context.uri, &context.headers)
    };
    let with = |document: Arc<Fixed>| {
        Endpoint::only("/openapi.json", document, operation.clone(), answer).open()
    };
    let own = with(Fixed::new(JSON, Bytes::new()));
    let document = api::document(endpoints.iter().chain([&own]));
    let mut text = serde_json::to_vec_pretty(&document).unwrap_or_default();
    text.push(b'\n');
    with(Fixed::new(JSON, text.into()))
}
