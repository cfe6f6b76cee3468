//! The names of a request: its id (`x-request-id`) and its place in a trace (W3C Trace Context).
//!
//! An id that a client or proxy sends is kept if it is short and plain, so that the same id is in
//! all logs; others are replaced, so that clients cannot write into our log.

use std::{
    hash::{BuildHasher as _, RandomState},
    sync::{
        LazyLock,
        atomic::{AtomicU64, Ordering},
    },
};

use http::{HeaderMap, HeaderName};

pub(super) const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");
const TRACEPARENT: HeaderName = HeaderName::from_static("traceparent");

const LONGEST: usize = 128;

/// A place in a trace: the client's span, if there is one, and ours below it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Trace {
    /// The trace, 32 hexadecimal digits.
    pub(super) trace: String,
    /// The client's span, 16 digits; `None` where the trace begins here.
    pub(super) parent: Option<String>,
    /// Our span, 16 digits.
    pub(super) span: String,
    pub(super) is_sampled: bool,
}

/// The id of a request, visible ASCII without quotes, by its headers if they name one.
pub(super) fn id(headers: &HeaderMap) -> String {
    let sent = text(headers, &REQUEST_ID).filter(|id| is_sane(id));
    sent.map_or_else(|| digits(next()), Into::into)
}

fn text<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    headers.get(name)?.to_str().ok()
}

fn is_sane(id: &str) -> bool {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.:/+=~@".contains(&byte);
    (1..=LONGEST).contains(&id.len()) && id.bytes().all(is_plain)
}

impl Trace {
    /// The place of a request in the client's trace, if it has one; `begins_one` says whether one without begins one.
    pub(super) fn of(headers: &HeaderMap, begins_one: impl FnOnce() -> bool) -> Option<Self> {
        let sent = text(headers, &TRACEPARENT).and_then(Self::read);
        sent.or_else(|| begins_one().then(Self::begun))
    }

    /// Reads `00-<trace>-<span>-<flags>`; later versions may have more behind it.
    fn read(text: &str) -> Option<Self> {
        let mut parts = text.splitn(5, '-');
        let (version, trace, parent, flags) =
            (parts.next()?, parts.next()?, parts.next()?, parts.next()?);
        let more = parts.next();
        let is_hex = |text: &str, length| {
            let is_digit = |b: u8| b.is_ascii_digit() || (b'a'..=b'f').contains(&b);
            text.len() == length && text.bytes().all(is_digit)
        };
        let is_named = |text: &str, length| is_hex(text, length) && text.bytes().any(|b| b != b'0');
        let is_in_order = is_hex(version, 2)
            && version != "ff"
            && (version != "00" || more.is_none())
            && is_named(trace, 32)
            && is_named(parent, 16)
            && is_hex(flags, 2);
        is_in_order.then(|| Self {
            trace: trace.into(),
            parent: Some(parent.into()),
            span: digits(next()),
            is_sampled: u8::from_str_radix(flags, 16).is_ok_and(|flags| flags & 1 == 1),
        })
    }

    /// A new one, which is kept.
    fn begun() -> Self {
        Self {
            trace: digits(next()) + &digits(next()),
            parent: None,
            span: digits(next()),
            is_sampled: true,
        }
    }
}

/// The sixteen hexadecimal digits of a number. (Formatting takes several times as long, and each request has one.)
fn digits(number: u64) -> String {
    let digit = |place: usize| b"0123456789abcdef"[((number >> (60 - 4 * place)) & 15) as usize];
    let digits: [u8; 16] = std::array::from_fn(digit);
    std::str::from_utf8(&digits).unwrap_or_default().into()
}

/// A number that no other process and no other request has, as good as surely: where the counter
/// begins is random, and what follows is mixed (splitmix64, a bijection).
pub(super) fn next() -> u64 {
    static NEXT: LazyLock<AtomicU64> =
        LazyLock::new(|| AtomicU64::new(RandomState::new().hash_one("request")));
    const STEP: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut z = NEXT.fetch_add(STEP, Ordering::Relaxed);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    // Zero is no name of a span.
    (z ^ (z >> 31)).max(1)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use http::HeaderValue;

    use super::*;

    #[test]
    fn ids_are_kept_if_they_are_plain() {
        let of = |text: &str| {
            let mut headers = HeaderMap::new();
            headers.insert(REQUEST_ID, HeaderValue::from_str(text).expect("a header"));
            id(&headers)
        };
        for kept in ["a", "3f1c-77", "Root=1-67891233-abcdef", &"x".repeat(128)] {
            assert_eq!(of(kept), kept);
        }
        for replaced in ["", "a b", "a\"b", "a,b", "é", "{}", &"x".repeat(129)] {
            let made = of(replaced);
            assert!(made.len() == 16 && made != replaced, "{replaced}: {made}");
        }
    }

    #[test]
    fn digits_are_those_of_the_number() {
        for number in [0, 1, 0x0123_4567_89ab_cdef, u64::MAX] {
            assert_eq!(digits(number), format!("{number:016x}"));
        }
    }

    #[test]
    fn made_ids_differ() {
        let ids: BTreeSet<_> = (0..10_000).map(|_| next()).collect();
        assert_eq!(ids.len(), 10_000);
    }

    #[test]
    fn traces_are_continued_if_they_are_in_order() {
        let (trace, parent) = ("4bf92f3577b34da6a3ce929d0e0e4736", "00f067aa0ba902b7");
        let good = format!("00-{trace}-{parent}-01");
        let later = format!("cc-{trace}-{parent}-00-what-else");
        for (text, is_sampled) in [(good.clone(), true), (later, false)] {
            let read = Trace::read(&text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(
                (&*read.trace, read.parent.as_deref()),
                (trace, Some(parent))
            );
            assert_eq!(read.is_sampled, is_sampled);
            assert!(read.span.len() == 16 && read.span != parent);
        }
        for bad in [
            "",
            "00",
            &format!("ff-{trace}-{parent}-01"),
            &format!("{good}-more"),
            &format!("00-{trace}-{parent}"),
            &format!("00-{}-{parent}-01", trace.to_uppercase()),
            &format!("00-{}-{parent}-01", "0".repeat(32)),
            &format!("00-{trace}-{}-01", "0".repeat(16)),
            &format!("00-{trace}0-{parent}-01"),
            &format!("00-{trace}-{parent}-1"),
        ] {
            assert_eq!(Trace::read(bad), None, "{bad}");
        }
    }
}
