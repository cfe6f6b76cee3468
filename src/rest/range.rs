//! `Range` (RFC 9110, 14): a part of the bytes of an answer whose points take equal numbers of bytes. Only the
//! points in that part are made.

use std::ops::Range;

use bytes::Bytes;
use futures_util::{Stream, StreamExt as _};
use http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use strew_service::Interrupted;

use super::{freshness::Freshness, problem::Problem};
use crate::body::Response;

/// The unit of ranges.
pub(super) const BYTES: HeaderValue = HeaderValue::from_static("bytes");

/// A single range, as a client writes it.
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
        let is_current = (headers.get(header::IF_RANGE)).is_none_or(|tag| tag == freshness.tag());
        let (unit, range) = text.split_once('=')?;
        let is_simple = unit.trim().eq_ignore_ascii_case("bytes") && !range.contains(',');
        if *method != Method::GET || !is_current || !is_simple {
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

/// A range of the bytes of a stream.
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
