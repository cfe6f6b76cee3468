//! The header `Vary`: the headers of requests that answers depend on.

use http::{
    HeaderMap, HeaderValue,
    header::{self, Entry},
};

/// A header that answers depend on.
pub(super) const ACCEPT_ENCODING: HeaderValue = HeaderValue::from_static("accept-encoding");
/// As [`ACCEPT_ENCODING`].
pub(super) const ORIGIN: HeaderValue = HeaderValue::from_static("origin");
/// What almost all answers with points depend on: the second is added to all answers.
pub(super) const BOTH: HeaderValue = HeaderValue::from_static("accept, accept-encoding");

/// Adds the name of a header.
pub(super) fn on(headers: &mut HeaderMap, name: HeaderValue) {
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
