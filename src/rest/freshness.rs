//! Whether a client's copy of an answer is still right (RFC 9110, 13; RFC 9111), and which part of an answer it lacks
//! (RFC 9110, 14).
//!
//! An answer is a pure function of the request, of the table and of the program, so its tag is a
//! hash of those and is known before a point is made. Tags are strong: equal tags, equal bytes. An
//! address that pins its table (`table=…`) is answered the same forever.

use std::{ops::Range, pin::Pin};

use bytes::Bytes;
use futures_util::{Stream, StreamExt as _};
use http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, Uri, header};
use serde::Serialize;
use strew_core::ALGORITHM_VERSION;
use strew_error::Error;
use strew_service::Interrupted;

use super::{
    coding::Decided,
    negotiate::{self, BY_BOTH, Coding},
    problem::Problem,
};
use crate::body::{Body, Response};

/// The tag of an answer and what else caches need, known before the answer is made.
#[derive(Clone, Debug)]
pub(super) struct Freshness {
    pub(super) tag: HeaderValue,
    pub(super) coding: Option<Coding>,
    is_text: bool,
    /// Whether the address pins the table, so that its answer never changes.
    pinned: bool,
    /// Whether `Accept` had a say in the content type.
    pub(super) negotiated: bool,
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
        if let Some(coding) = coding {
            tag.push(b'-');
            tag.extend_from_slice(coding.name().as_bytes());
        }
        tag.push(b'"');
        Self {
            tag: HeaderValue::from_bytes(&tag).unwrap_or(HeaderValue::from_static("\"\"")),
            coding,
            is_text: negotiate::is_text(content_type),
            pinned: false,
            negotiated: false,
        }
    }

    pub(super) fn pinned(mut self, pinned: bool) -> Self {
        self.pinned = pinned;
        self
    }

    /// Answers a conditional request: makes the answer if the client needs it. One that fails is answered as it would
    /// be without conditions.
    pub(super) async fn answer(
        self,
        headers: &HeaderMap,
        make: Pin<&mut impl Future<Output = Result<Response, Error>>>,
    ) -> Result<Response, Error> {
        let verdict = self.verdict(headers);
        if verdict == Verdict::Same {
            // A client with this tag was answered before.
            return Ok(self.instead(verdict));
        }
        let mut response = make.await?;
        if verdict != Verdict::Wanted && response.status().is_success() {
            return Ok(self.instead(verdict));
        }
        self.stamp(&mut response);
        Ok(response)
    }

    /// What the conditions of a GET or HEAD make of its answer, in the order of RFC 9110, 13.2.2: `If-Match`, then
    /// `If-None-Match`. Answers have no date of change, so conditions about dates do not count (13.1.3 and 13.1.4).
    pub(super) fn verdict(&self, headers: &HeaderMap) -> Verdict {
        match self.listed(headers, &header::IF_MATCH, false) {
            Listed::Other => return Verdict::Failed,
            Listed::Absent | Listed::Ours | Listed::Any => {}
        }
        match self.listed(headers, &header::IF_NONE_MATCH, true) {
            Listed::Ours => Verdict::Same,
            Listed::Any => Verdict::Unwanted,
            Listed::Absent | Listed::Other => Verdict::Wanted,
        }
    }

    pub(super) fn stamp(self, response: &mut Response) {
        response.headers_mut().insert(header::ETAG, self.tag);
        // Of another type than text no coding would be chosen later, either.
        if self.is_text {
            response.extensions_mut().insert(Decided(self.coding));
        }
        if self.negotiated {
            response.headers_mut().insert(header::VARY, BY_BOTH);
        }
        if self.pinned {
            response.extensions_mut().insert(Pinned);
        }
    }

    /// The answer to a client that does not want what there is.
    pub(super) fn instead(self, verdict: Verdict) -> Response {
        if verdict == Verdict::Failed {
            let ours = String::from_utf8_lossy(self.tag.as_bytes());
            let detail =
                format!("`if-match`: no tag of the answer is in it; allowed: {ours}, or *");
            return Problem::of_status(StatusCode::PRECONDITION_FAILED, detail);
        }
        let mut response = Response::new(Body::empty());
        // With what is put onto it later there are a dozen: a map that grows is filled anew.
        response.headers_mut().reserve(12);
        *response.status_mut() = StatusCode::NOT_MODIFIED;
        self.stamp(&mut response);
        response
    }

    /// Whether a list of tags has ours, by weak comparison or by strong, which no weak tag passes. Our tags hold
    /// neither commas nor quotes, so that splitting at commas cannot fake one.
    fn listed(&self, headers: &HeaderMap, name: &HeaderName, weakly: bool) -> Listed {
        if !headers.contains_key(name) {
            return Listed::Absent;
        }
        let ours = self.tag.as_bytes();
        let lines = headers.get_all(name).iter().map(HeaderValue::as_bytes);
        let tags = lines.flat_map(|line| line.split(|&byte| byte == b','));
        let mut tags = tags.map(<[u8]>::trim_ascii).filter(|tag| !tag.is_empty());
        let first = tags.next();
        if first == Some(b"*") && tags.next().is_none() {
            return Listed::Any;
        }
        let is_ours = |tag: &[u8]| {
            let strong = tag.strip_prefix(b"W/").filter(|_| weakly);
            strong.unwrap_or(tag) == ours
        };
        match first.into_iter().chain(tags).any(is_ours) {
            true => Listed::Ours,
            false => Listed::Other,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    Wanted,
    /// The client has it: 304.
    Same,
    /// The client wants none if there is any: 304.
    Unwanted,
    /// The client wants another one: 412.
    Failed,
}

#[derive(Debug)]
enum Listed {
    Absent,
    Ours,
    Any,
    Other,
}

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

pub(super) const BYTES: HeaderValue = HeaderValue::from_static("bytes");

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// From a byte on, up to one that is included.
    From(u64, Option<u64>),
    /// So many of the last bytes.
    Last(u64),
}

impl Wanted {
    /// The range of a request, if it has one that counts: other methods, several ranges, other units, and copies
    /// that `If-Range` says are of something else get the whole answer.
    pub(super) fn of(method: &Method, headers: &HeaderMap, freshness: &Freshness) -> Option<Self> {
        let text = headers.get(header::RANGE)?.to_str().ok()?;
        let is_current = (headers.get(header::IF_RANGE)).is_none_or(|tag| tag == freshness.tag);
        let (unit, range) = text.split_once('=')?;
        let is_simple = unit.trim().eq_ignore_ascii_case("bytes") && !range.contains(',');
        // The parts of what is compressed are not those of the text.
        if *method != Method::GET || !is_current || !is_simple || freshness.coding.is_some() {
            return None;
        }
        let number = |digits: &str| {
            let is_plain = digits.bytes().all(|byte| byte.is_ascii_digit());
            is_plain.then(|| digits.parse().unwrap_or(u64::MAX))
        };
        match range.trim().split_once('-')? {
            ("", "") => None,
            ("", last) => Some(Self::Last(number(last)?)),
            (first, "") => Some(Self::From(number(first)?, None)),
            (first, last) => {
                let (first, last) = (number(first)?, number(last)?);
                (first <= last).then_some(Self::From(first, Some(last)))
            }
        }
    }

    /// Which of `size` bytes it means; `None` if none of them.
    pub(super) fn within(self, size: u64) -> Option<Range<u64>> {
        let range = match self {
            Self::From(first, None) => first..size,
            Self::From(first, Some(last)) => first..size.min(last.saturating_add(1)),
            Self::Last(count) => size.saturating_sub(count)..size,
        };
        (range.start < range.end).then_some(range)
    }
}

pub(super) fn cut(
    blocks: impl Stream<Item = Result<Bytes, Interrupted>>,
    mut range: Range<u64>,
) -> impl Stream<Item = Result<Bytes, Interrupted>> {
    blocks.map(move |block| {
        let mut block = block?;
        let length = block.len() as u64;
        let at = |place: u64| usize::try_from(place.min(length)).unwrap_or(usize::MAX);
        block = block.slice(at(range.start)..at(range.end));
        range = range.start.saturating_sub(length)..range.end.saturating_sub(length);
        Ok(block)
    })
}

/// The answer to a range that has no byte of the answer.
pub(super) fn unsatisfiable(size: u64) -> Response {
    let detail = format!(
        "`range`: no byte of the answer is in it; allowed: bytes 0 to {size}, the end excluded"
    );
    let mut response = Problem::of_status(StatusCode::RANGE_NOT_SATISFIABLE, detail);
    let headers = response.headers_mut();
    if let Ok(place) = HeaderValue::from_str(&format!("bytes */{size}")) {
        headers.insert(header::CONTENT_RANGE, place);
    }
    headers.insert(header::ACCEPT_RANGES, BYTES);
    response
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
    fn conditions_count_in_the_order_of_the_rfc() {
        use Verdict::{Failed, Same, Unwanted, Wanted};
        let ours = of("/a", "identity", "table");
        let tag = ours.tag.to_str().expect("text").to_owned();
        let (if_match, if_none_match) = (header::IF_MATCH, header::IF_NONE_MATCH);
        let past = "Sat, 01 Jan 2000 00:00:00 GMT";
        let verdict = |lines: &[(&HeaderName, &str)]| {
            let mut headers = HeaderMap::new();
            for (name, line) in lines {
                let line = line.replace("OURS", &tag);
                headers.append(*name, HeaderValue::from_str(&line).expect("text"));
            }
            ours.verdict(&headers)
        };
        // By weak comparison (RFC 9110, 13.1.2).
        for (lines, expected) in [
            (&["OURS"][..], Same),
            (&["W/OURS"], Same),
            (&["\"x\", W/\"y\",OURS "], Same),
            (&["\"x\"", "OURS"], Same),
            (&["\"x\""], Wanted),
            (&[tag.trim_matches('"')], Wanted),
            (&["w/OURS"], Wanted),
            (&[" * "], Unwanted),
            (&["\"x\", *"], Wanted),
        ] {
            let lines: Vec<_> = lines.iter().map(|line| (&if_none_match, *line)).collect();
            assert_eq!(verdict(&lines), expected, "{lines:?}");
        }
        // By strong comparison (13.1.1).
        for (lines, expected) in [
            (&["OURS"][..], Wanted),
            (&["\"x\", OURS"], Wanted),
            (&["\"x\"", "OURS"], Wanted),
            (&["*"], Wanted),
            (&["W/OURS"], Failed),
            (&["\"x\""], Failed),
            (&["x"], Failed),
            (&[""], Failed),
            (&["*, \"x\""], Failed),
        ] {
            let lines: Vec<_> = lines.iter().map(|line| (&if_match, *line)).collect();
            assert_eq!(verdict(&lines), expected, "{lines:?}");
        }
        for (lines, expected) in [
            (&[][..], Wanted),
            (&[(&if_match, "\"x\""), (&if_none_match, "OURS")], Failed),
            (&[(&if_match, "OURS"), (&if_none_match, "OURS")], Same),
            (&[(&if_match, "*"), (&if_none_match, "*")], Unwanted),
            (&[(&header::IF_UNMODIFIED_SINCE, past)], Wanted),
            (&[(&header::IF_MODIFIED_SINCE, past)], Wanted),
        ] {
            assert_eq!(verdict(lines), expected, "{lines:?}");
        }
    }

    #[test]
    fn a_range_is_cut_to_the_bytes_that_there_are() {
        for (wanted, expected) in [
            (Wanted::From(0, Some(9)), Some(0..10)),
            (Wanted::From(5, None), Some(5..100)),
            (Wanted::From(5, Some(u64::MAX)), Some(5..100)),
            (Wanted::From(99, Some(99)), Some(99..100)),
            (Wanted::From(100, None), None),
            (Wanted::Last(1), Some(99..100)),
            (Wanted::Last(1000), Some(0..100)),
            (Wanted::Last(0), None),
        ] {
            assert_eq!(wanted.within(100), expected, "{wanted:?}");
        }
    }
}
