//! `/docs`: a page for people that shows `/openapi.json`. It loads nothing from elsewhere.

use axum::{response::Response, routing};
use bytes::Bytes;
use http::{HeaderMap, HeaderValue, Method, Uri, header};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    fixed::Fixed,
};
use crate::service::query::groups;

const PAGE: &str = include_str!("docs/page.html");
const STYLE: &str = include_str!("docs/page.css");
const SCRIPT: &str = include_str!("docs/page.js");

/// What the page may load: its own style, its own script, the document.
const POLICY: &str = "default-src 'none'; style-src 'self'; script-src 'self'; connect-src 'self'; \
                      img-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The page and its parts.
pub(super) fn endpoints() -> Vec<Endpoint> {
    let page = (
        "/docs",
        "getDocs",
        "The API as a page",
        "text/html; charset=utf-8",
        PAGE,
    );
    let style = (
        "/docs/page.css",
        "getDocsStyle",
        "The page's style",
        "text/css",
        STYLE,
    );
    let script = (
        "/docs/page.js",
        "getDocsScript",
        "The page's script",
        "text/javascript",
        SCRIPT,
    );
    [page, style, script].map(endpoint).into()
}

type Part = (
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    &'static str,
);

fn endpoint((path, id, summary, content_type, content): Part) -> Endpoint {
    let operation = Operation {
        method: Method::GET,
        id,
        summary,
        about: "For people; loads nothing from elsewhere.",
        tag: Tag::About,
        path_parameters: &[],
        parameters: groups::NONE,
        body: None,
        answers: vec![
            api::Answer {
                status: 200,
                about: summary,
                headers: vec![],
                contents: vec![(content_type, schemas::text)],
            },
            api::Answer::unchanged(),
        ],
        problems: vec![],
        example: path.into(),
    };
    let document = Fixed::new(content_type, Bytes::from_static(content.as_bytes()));
    let answer = move |uri: Uri, headers: HeaderMap| async move { part(&document, &uri, &headers) };
    let handler = routing::get(answer);
    Endpoint::new(path, (), vec![(operation, handler)]).open()
}

fn part(document: &Fixed, uri: &Uri, headers: &HeaderMap) -> Response {
    let mut response = document.answer(uri, headers);
    let headers = response.headers_mut();
    let policy = HeaderValue::from_static(POLICY);
    headers.insert(header::CONTENT_SECURITY_POLICY, policy);
    response
}
