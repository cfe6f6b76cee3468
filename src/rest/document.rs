//! Answers that are one document: JSON or a file of another type, made for the request; or one that never changes while
//! the daemon runs, such as a page.

use std::sync::Arc;

use bytes::Bytes;
use http::{HeaderMap, HeaderValue, Uri, header};
use serde::Serialize;
use strew_error::Error;

use super::{
    coding::Encoder,
    freshness::{Freshness, Verdict},
    negotiate::Coding,
};
use crate::body::{Body, Response};

pub const JSON: &str = "application/json";

pub fn json(document: &impl Serialize) -> Result<Response, Error> {
    Ok(file(written(document)?, JSON))
}

/// The bytes of a document: one line.
pub(super) fn written(document: &impl Serialize) -> Result<Vec<u8>, Error> {
    let mut body = serde_json::to_vec(document)
        .map_err(|_| Error::Internal("a document cannot be written"))?;
    body.push(b'\n');
    Ok(body)
}

/// An answer that is true for a moment only, and never kept.
pub fn momentary(mut response: Response) -> Response {
    let value = HeaderValue::from_static("no-store");
    response.headers_mut().insert(header::CACHE_CONTROL, value);
    response
}

pub fn file(bytes: impl Into<Body>, content_type: &'static str) -> Response {
    let mut response = Response::new(bytes.into());
    // With what is put onto it later there are a dozen: a map that grows is filled anew.
    response.headers_mut().reserve(16);
    let value = HeaderValue::from_static(content_type);
    response.headers_mut().insert(header::CONTENT_TYPE, value);
    response
}

/// A document that never changes. Compressed once, at the start or earlier, so that answering with it holds nothing but
/// its place.
pub(super) struct Fixed {
    content_type: &'static str,
    digest: String,
    plain: Bytes,
    coded: Vec<(Coding, Bytes)>,
}

impl Fixed {
    pub(super) fn new(content_type: &'static str, plain: Bytes) -> Arc<Self> {
        let coded = |coding| {
            let coded = Encoder::whole(coding, &plain).ok()?;
            Some((coding, coded))
        };
        let coded: Vec<_> = Coding::ALL.into_iter().filter_map(coded).collect();
        Self::coded(content_type, plain, coded)
    }

    pub(super) fn coded(
        content_type: &'static str,
        plain: Bytes,
        coded: impl IntoIterator<Item = (Coding, Bytes)>,
    ) -> Arc<Self> {
        Arc::new(Self {
            content_type,
            digest: blake3::hash(&plain).to_hex().to_string(),
            coded: coded.into_iter().collect(),
            plain,
        })
    }

    pub(super) fn answer(&self, uri: &Uri, headers: &HeaderMap) -> Response {
        let freshness = Freshness::of(uri, headers, self.content_type, &self.digest);
        let verdict = freshness.verdict(headers);
        if verdict != Verdict::Wanted {
            return freshness.instead(verdict);
        }
        let chosen = freshness.coding;
        let coded = self
            .coded
            .iter()
            .find(|(coding, _)| Some(*coding) == chosen);
        let content = coded.map_or(&self.plain, |(_, content)| content);
        let mut response = file(content.clone(), self.content_type);
        if let Some((coding, _)) = coded {
            let name = HeaderValue::from_static(coding.name());
            let headers = response.headers_mut();
            headers.insert(header::CONTENT_ENCODING, name);
        }
        freshness.stamp(&mut response);
        response
    }
}
