//! The header `Vary`: the headers of requests that answers depend on.

use http::{HeaderMap, HeaderValue, header};

/// Adds the name of a header.
pub(super) fn on(headers: &mut HeaderMap, name: &'static str) {
    let joined = match headers.get(header::VARY).map(HeaderValue::to_str) {
        Some(Ok(before)) => HeaderValue::from_str(&format!("{before}, {name}")).ok(),
        _ => None,
    };
    headers.insert(
        header::VARY,
        joined.unwrap_or(HeaderValue::from_static(name)),
    );
}
