//! Headers that all answers have: `Vary`, with the headers of requests that they depend on, and those that keep browsers
//! from taking an answer for what it is not.

use http::{
    HeaderMap, HeaderName, HeaderValue,
    header::{self, Entry},
};

pub(super) const ACCEPT_ENCODING: HeaderValue = HeaderValue::from_static("accept-encoding");
pub(super) const ORIGIN: HeaderValue = HeaderValue::from_static("origin");
/// `Vary` of almost all answers with points; all answers get the second name.
pub(super) const BOTH: HeaderValue = HeaderValue::from_static("accept, accept-encoding");

pub(super) fn vary(headers: &mut HeaderMap, name: HeaderValue) {
    let line = match headers.entry(header::VARY) {
        Entry::Vacant(line) => {
            line.insert(name);
            return;
        }
        Entry::Occupied(line) => line.into_mut(),
    };
    if *line == BOTH && name == ACCEPT_ENCODING {
        return;
    }
    if let Ok(joined) = HeaderValue::from_bytes(&[line.as_bytes(), b", ", name.as_bytes()].concat())
    {
        *line = joined;
    }
}

const NO_SNIFFING: HeaderValue = HeaderValue::from_static("nosniff");
const NO_REFERRER: HeaderValue = HeaderValue::from_static("no-referrer");
/// The policy of an answer that is no page: a browser that opens it loads and runs nothing. Pictures bring
/// their own style.
const NO_PAGE: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'; sandbox",
);

const RESOURCE_POLICY: HeaderName = HeaderName::from_static("cross-origin-resource-policy");
const ANY_ORIGIN: HeaderValue = HeaderValue::from_static("cross-origin");
const SAME_ORIGIN: HeaderValue = HeaderValue::from_static("same-origin");

/// Sets the headers of an answer; pages have all but the last one. If all pages may read answers, they may also show
/// them as pictures.
pub(super) fn guard(headers: &mut HeaderMap, all_may_read: bool) {
    let resource = if all_may_read {
        ANY_ORIGIN
    } else {
        SAME_ORIGIN
    };
    if !headers.contains_key(header::CONTENT_SECURITY_POLICY) {
        headers.insert(header::X_CONTENT_TYPE_OPTIONS, NO_SNIFFING);
        headers.insert(header::REFERRER_POLICY, NO_REFERRER);
        headers.insert(header::CONTENT_SECURITY_POLICY, NO_PAGE);
    }
    headers.insert(RESOURCE_POLICY, resource);
}
