//! Headers that keep browsers from taking an answer for what it is not, whoever made it.

use http::{HeaderMap, HeaderName, HeaderValue, header};

/// What an answer that is no page may load or run when somebody opens it: nothing. Pictures bring
/// their own style.
const NO_PAGE: &str =
    "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'; sandbox";

/// Sets them where nobody has. If all pages may read answers, they may also show them as pictures.
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
        (
            HeaderName::from_static("cross-origin-resource-policy"),
            resource,
        ),
    ] {
        let slot = headers.entry(name);
        slot.or_insert(HeaderValue::from_static(value));
    }
}
