//! Headers that keep browsers from taking any answer for what it is not.

use http::{HeaderMap, HeaderName, HeaderValue, header};

/// The policy of an answer that is no page: a browser that opens it loads and runs nothing. Pictures bring
/// their own style.
const NO_PAGE: &str =
    "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'; sandbox";

const RESOURCE_POLICY: HeaderName = HeaderName::from_static("cross-origin-resource-policy");

/// Sets the headers that an answer lacks. If all pages may read answers, they may also show them as pictures.
pub(super) fn guard(headers: &mut HeaderMap, all_may_read: bool) {
    let resource = if all_may_read {
        "cross-origin"
    } else {
        "same-origin"
    };
    for (name, value) in [
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CONTENT_SECURITY_POLICY, NO_PAGE),
        (RESOURCE_POLICY, resource),
    ] {
        if !headers.contains_key(&name) {
            headers.insert(name, HeaderValue::from_static(value));
        }
    }
}
