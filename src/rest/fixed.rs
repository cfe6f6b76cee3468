//! Documents that never change while the daemon runs: the pages and the description of the API.
//!
//! They are compressed once, at the start or earlier, so that answering one holds nothing but its place.

use std::sync::Arc;

use bytes::Bytes;
use http::{HeaderMap, HeaderValue, Uri, header};

use super::{
    coding::{Coding, Encoder},
    freshness::{Freshness, Verdict},
};
use crate::body::{Body, Response};

/// A document. Cheap to clone.
#[derive(Clone, Debug)]
pub(super) struct Fixed {
    inner: Arc<Inner>,
}

#[derive(Debug)]
struct Inner {
    content_type: &'static str,
    digest: String,
    plain: Bytes,
    /// In each coding.
    coded: Vec<(Coding, Bytes)>,
}

impl Fixed {
    /// Compresses a document.
    pub(super) fn new(content_type: &'static str, plain: Bytes) -> Self {
        let coded = |coding| {
            let coded = Encoder::whole(coding, &plain).ok()?;
            Some((coding, coded))
        };
        let coded: Vec<_> = Coding::ALL.into_iter().filter_map(coded).collect();
        Self::coded(content_type, plain, coded)
    }

    /// A document that is compressed already, in some codings.
    pub(super) fn coded(
        content_type: &'static str,
        plain: Bytes,
        coded: impl IntoIterator<Item = (Coding, Bytes)>,
    ) -> Self {
        Self {
            inner: Arc::new(Inner {
                content_type,
                digest: blake3::hash(&plain).to_hex().to_string(),
                coded: coded.into_iter().collect(),
                plain,
            }),
        }
    }

    /// The document as an answer to a request.
    pub(super) fn answer(&self, uri: &Uri, headers: &HeaderMap) -> Response {
        let inner = &*self.inner;
        let freshness = Freshness::of(uri, headers, inner.content_type, &inner.digest);
        let verdict = freshness.verdict(headers);
        if verdict != Verdict::Wanted {
            return freshness.instead(verdict);
        }
        let chosen = freshness.coding();
        let coded = inner
            .coded
            .iter()
            .find(|(coding, _)| Some(*coding) == chosen);
        let content = coded.map_or(&inner.plain, |(_, content)| content);
        let mut response = Response::new(Body::from(content.clone()));
        let headers = response.headers_mut();
        let content_type = HeaderValue::from_static(inner.content_type);
        headers.insert(header::CONTENT_TYPE, content_type);
        if let Some((coding, _)) = coded {
            let name = HeaderValue::from_static(coding.name());
            headers.insert(header::CONTENT_ENCODING, name);
        }
        freshness.stamp(&mut response);
        response
    }
}
