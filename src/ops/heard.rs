//! Which of the headers that decide how a request is answered it has.
//!
//! Most have none or few, and a look through all names takes less than a search for each.

use http::HeaderMap;

/// The headers that a request has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Heard {
    /// `Content-Type`.
    pub(super) content_type: bool,
    /// `X-Forwarded-For`.
    pub(super) forwarded: bool,
    /// `X-Request-Id` or `Traceparent`.
    pub(super) identity: bool,
    /// `X-Api-Key` or `Authorization`.
    pub(super) key: bool,
    /// `Origin` or `Accept-Encoding`.
    pub(super) wishes: bool,
}

impl Heard {
    /// Those among a request's headers.
    pub(super) fn of(headers: &HeaderMap) -> Self {
        let mut heard = Self::default();
        for name in headers.keys() {
            let slot = match name.as_str() {
                "content-type" => &mut heard.content_type,
                "x-forwarded-for" => &mut heard.forwarded,
                "x-request-id" | "traceparent" => &mut heard.identity,
                "x-api-key" | "authorization" => &mut heard.key,
                "origin" | "accept-encoding" => &mut heard.wishes,
                _ => continue,
            };
            *slot = true;
        }
        heard
    }
}

#[cfg(test)]
mod tests {
    use http::HeaderValue;

    use super::*;

    #[test]
    fn each_name_is_heard() {
        let of = |name: &'static str| {
            let headers = [(name.parse().expect("a name"), HeaderValue::from_static("a"))];
            Heard::of(&HeaderMap::from_iter(headers))
        };
        assert_eq!(of("host"), Heard::default());
        assert!(of("Content-Type").content_type && of("X-Forwarded-For").forwarded);
        assert!(of("X-Request-Id").identity && of("Traceparent").identity);
        assert!(of("X-Api-Key").key && of("Authorization").key);
        assert!(of("Origin").wishes && of("Accept-Encoding").wishes);
    }
}
