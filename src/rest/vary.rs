//! The header `Vary`: the headers of requests that answers depend on.

use http::{HeaderMap, HeaderValue, header};

/// Adds the name of a header.
pub(super) fn on(headers: &mut HeaderMap, name: &'static str) {
    let before = headers.insert(header::VARY, HeaderValue::from_static(name));
    let Some(Ok(before)) = before.as_ref().map(HeaderValue::to_str) else {
        return;
    };
    if let Ok(joined) = HeaderValue::from_str(&[before, ", ", name].concat()) {
        headers.insert(header::VARY, joined);
    }
}
