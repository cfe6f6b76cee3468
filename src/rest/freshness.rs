//! Whether a client's copy of an answer is still right (RFC 9110, 13; RFC 9111).
//!
//! An answer is a pure function of the request, of the table and of the program, so its tag is a
//! hash of those and is known before a point is made. Tags are strong: equal tags, equal bytes. An
//! address that pins its table (`table=…`) is answered the same forever.

use std::pin::Pin;

use http::{HeaderMap, HeaderValue, StatusCode, Uri, header};
use serde::Serialize;
use strew_core::ALGORITHM_VERSION;
use strew_error::Error;

use super::{
    coding::{Coding, Decided},
    vary,
};
use crate::body::{Body, Response};

/// The tag of an answer and what else caches need, known before the answer is made.
#[derive(Clone, Debug)]
pub(super) struct Freshness {
    tag: HeaderValue,
    coding: Option<Coding>,
    is_text: bool,
    pinned: bool,
    negotiated: bool,
}

/// An answer that never changes; travels with the response to where `Cache-Control` is set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pinned;

impl Freshness {
    /// The freshness of an answer to a request for `uri`, in a content type, `made_of` all that
    /// decides its bytes besides the address: digests of tables, settings.
    ///
    /// The address goes in as it was written: that is quicker than the query that was read from it, and distinguishes
    /// at least as much.
    pub(super) fn of(
        uri: &Uri,
        headers: &HeaderMap,
        content_type: &'static str,
        made_of: &impl Serialize,
    ) -> Self {
        // Numbers and texts can always be written.
        Self::made(uri, headers, content_type, |written| {
            let _ = serde_json::to_writer(written, made_of);
        })
    }

    /// As [`of`](Self::of), with a function that writes what decides the bytes.
    pub(super) fn made(
        uri: &Uri,
        headers: &HeaderMap,
        content_type: &'static str,
        write: impl FnOnce(&mut Vec<u8>),
    ) -> Self {
        let coding = Coding::chosen(headers, content_type);
        let asked = uri.path_and_query().map_or("", |asked| asked.as_str());
        let mut written = Vec::with_capacity(512);
        written.extend_from_slice(&ALGORITHM_VERSION.to_le_bytes());
        // None of these has a line break.
        for part in [env!("CARGO_PKG_VERSION"), asked, content_type] {
            written.extend_from_slice(part.as_bytes());
            written.push(b'\n');
        }
        write(&mut written);
        let hash = blake3::hash(&written);
        let mut tag = written;
        tag.clear();
        tag.push(b'"');
        let digits: [u8; 32] = std::array::from_fn(|place| {
            let byte = hash.as_bytes()[place / 2];
            let digit = if place % 2 == 0 { byte >> 4 } else { byte & 15 };
            b"0123456789abcdef"[usize::from(digit)]
        });
        tag.extend_from_slice(&digits);
        tag.extend_from_slice(coding.map_or("", Coding::suffix).as_bytes());
        tag.push(b'"');
        Self {
            tag: HeaderValue::from_bytes(&tag).unwrap_or(HeaderValue::from_static("\"\"")),
            coding,
            is_text: Coding::is_for(content_type),
            pinned: false,
            negotiated: false,
        }
    }

    /// The tag of the answer.
    pub(super) const fn tag(&self) -> &HeaderValue {
        &self.tag
    }

    /// The coding of the answer, which its tag says.
    pub(super) const fn coding(&self) -> Option<Coding> {
        self.coding
    }

    /// Says that `Accept` had a say in the content type.
    pub(super) fn negotiated(mut self) -> Self {
        self.negotiated = true;
        self
    }

    /// Whether the address pins the table, so that its answer never changes.
    pub(super) fn pinned(mut self, pinned: bool) -> Self {
        self.pinned = pinned;
        self
    }

    /// Answers a conditional request: makes the answer if the client needs it.
    ///
    /// # Errors
    /// As making it.
    pub(super) async fn answer(
        self,
        headers: &HeaderMap,
        make: Pin<&mut impl Future<Output = Result<Response, Error>>>,
    ) -> Result<Response, Error> {
        if self.is_listed(headers) {
            return Ok(self.not_modified());
        }
        let mut response = make.await?;
        if Self::is_any_unwanted(headers) {
            return Ok(self.not_modified());
        }
        self.stamp(&mut response);
        Ok(response)
    }

    /// Whether a client wants no answer if there is any.
    pub(super) fn is_any_unwanted(headers: &HeaderMap) -> bool {
        let tag = headers.get(header::IF_NONE_MATCH);
        tag.is_some_and(|tag| tag.as_bytes().trim_ascii() == b"*")
    }

    /// Puts what caches need onto an answer.
    pub(super) fn stamp(self, response: &mut Response) {
        response.headers_mut().insert(header::ETAG, self.tag);
        // Of another type than text no coding would be chosen later, either.
        if self.is_text {
            response.extensions_mut().insert(Decided(self.coding));
        }
        if self.negotiated {
            response.headers_mut().insert(header::VARY, vary::BOTH);
        }
        if self.pinned {
            response.extensions_mut().insert(Pinned);
        }
    }

    /// The answer to a client that has the current copy, or wants none if there is any.
    pub(super) fn not_modified(self) -> Response {
        let mut response = Response::new(Body::empty());
        // With what is put onto it later there are a dozen: a map that grows is filled anew.
        response.headers_mut().reserve(12);
        *response.status_mut() = StatusCode::NOT_MODIFIED;
        self.stamp(&mut response);
        response
    }

    /// Whether one of the tags in `If-None-Match` is ours, by weak comparison. Our tags hold
    /// neither commas nor quotes, so that splitting at commas cannot fake one.
    pub(super) fn is_listed(&self, headers: &HeaderMap) -> bool {
        let ours = self.tag.as_bytes();
        headers
            .get_all(header::IF_NONE_MATCH)
            .iter()
            .flat_map(|line| line.as_bytes().split(|&byte| byte == b','))
            .map(<[u8]>::trim_ascii)
            .any(|tag| tag.strip_prefix(b"W/").unwrap_or(tag) == ours)
    }
}

/// How long answers may be kept.
#[derive(Clone, Debug)]
pub(super) struct Keeping {
    pinned: HeaderValue,
    tagged: HeaderValue,
}

impl Keeping {
    /// For so many seconds unless their address pins them; those that are private by their client alone.
    pub(super) fn new(seconds: u32, is_private: bool) -> Self {
        let who = if is_private { "private" } else { "public" };
        let timed = |text: String| {
            HeaderValue::from_str(&text).unwrap_or(HeaderValue::from_static("no-cache"))
        };
        Self {
            pinned: timed(format!("{who}, max-age=31536000, immutable")),
            tagged: timed(format!("{who}, max-age={seconds}")),
        }
    }

    /// Sets how long an answer may be kept, unless it says so already.
    pub(super) fn set(&self, response: &mut Response) {
        let pinned = response.extensions().get::<Pinned>().is_some();
        let headers = response.headers_mut();
        if headers.contains_key(header::CACHE_CONTROL) {
            return;
        }
        let value = if pinned {
            self.pinned.clone()
        } else if headers.contains_key(header::ETAG) {
            self.tagged.clone()
        } else {
            HeaderValue::from_static("no-store")
        };
        headers.insert(header::CACHE_CONTROL, value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(address: &'static str, accept_encoding: &'static str, made_of: &str) -> Freshness {
        let mut headers = HeaderMap::new();
        let value = HeaderValue::from_static(accept_encoding);
        headers.insert(header::ACCEPT_ENCODING, value);
        let uri = Uri::from_static(address);
        Freshness::of(&uri, &headers, "application/json", &made_of)
    }

    #[test]
    fn a_tag_depends_on_all_that_an_answer_is_made_of_and_on_its_coding() {
        let base = of("/a?b=1", "identity", "table");
        assert_eq!(base.tag, of("/a?b=1", "identity", "table").tag);
        for other in [
            of("/a?b=2", "identity", "table"),
            of("/b?b=1", "identity", "table"),
            of("/a?b=1", "identity", "other"),
            of("/a?b=1", "gzip", "table"),
            of("/a?b=1", "zstd", "table"),
        ] {
            assert_ne!(base.tag, other.tag);
        }
    }

    #[test]
    fn tags_match_weakly_in_lists_and_over_lines() {
        let ours = of("/a", "identity", "table");
        let tag = ours.tag.to_str().expect("text").to_owned();
        let listed = |lines: &[String]| {
            let mut headers = HeaderMap::new();
            for line in lines {
                let line = HeaderValue::from_str(line).expect("text");
                headers.append(header::IF_NONE_MATCH, line);
            }
            ours.is_listed(&headers)
        };
        assert!(listed(std::slice::from_ref(&tag)));
        assert!(listed(&[format!("W/{tag}")]));
        assert!(listed(&[format!("\"x\", W/\"y\",{tag} ")]));
        assert!(listed(&["\"x\"".into(), tag.clone()]));
        assert!(!listed(&[]));
        assert!(!listed(&["\"x\"".into()]));
        assert!(!listed(&[tag.trim_matches('"').into()]));
        assert!(!listed(&[format!("w/{tag}")]));
        assert!(!listed(&["*".into()]));
    }
}
