//! Pages of other origins as clients (the Fetch standard's CORS protocol), without credentials that
//! browsers add by themselves: keys are headers that a page has to know.

use http::{HeaderMap, HeaderValue, Method, StatusCode, header};

use super::{host::Hosts, vary};
use crate::body::{Body, Request, Response};

const ALL: HeaderValue = HeaderValue::from_static("*");

/// The origins whose pages may send requests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Origins {
    /// Every page.
    All,
    /// Pages of these origins.
    Some(Vec<String>),
}

impl Origins {
    /// From a setting: `*`, or origins with spaces or commas between them.
    pub(super) fn read(text: &str) -> Self {
        let mut origins = text
            .split([' ', ','])
            .filter(|origin| !origin.is_empty())
            .map(str::to_ascii_lowercase);
        if text.trim() == "*" {
            return Self::All;
        }
        Self::Some(origins.by_ref().collect())
    }

    /// The origins that may read the answer to a page of an origin.
    fn allowed(&self, origin: &HeaderValue) -> Option<HeaderValue> {
        match self {
            Self::All => Some(ALL),
            Self::Some(origins) => {
                let lower = origin.as_bytes().to_ascii_lowercase();
                let known = origins.iter().any(|known| known.as_bytes() == lower);
                known.then(|| origin.clone())
            }
        }
    }
}

/// Why a page of another origin may not send a request, if that is not only for reading: browsers send some with a
/// body without a preflight. Any page may send requests that only read, and then cannot see the answer.
pub(super) fn refusal(origins: &Origins, hosts: &Hosts, request: &Request) -> Option<String> {
    let method = request.method();
    if [Method::GET, Method::HEAD, Method::OPTIONS].contains(method) {
        return None;
    }
    let origin = request.headers().get(header::ORIGIN)?;
    if hosts.is_own(origin, request) || origins.allowed(origin).is_some() {
        return None;
    }
    let origin: String = String::from_utf8_lossy(origin.as_bytes())
        .chars()
        .take(100)
        .collect();
    Some(format!(
        "pages of `{origin}` may not send {method}; allowed: this server's own pages, and those of \
         http.cors_origins"
    ))
}

/// The seconds for which a browser may keep the answer to a preflight request; browsers cut it.
const REMEMBER: &str = "86400";

/// The answer to a preflight request.
pub(super) fn preflight(
    origins: &Origins,
    method: &Method,
    headers: &HeaderMap,
) -> Option<Response> {
    let has = |name| headers.contains_key(name);
    let is_one = method == Method::OPTIONS
        && has(header::ACCESS_CONTROL_REQUEST_METHOD)
        && has(header::ORIGIN);
    if !is_one {
        return None;
    }
    let mut response = Response::new(Body::empty());
    *response.status_mut() = StatusCode::NO_CONTENT;
    let answer = response.headers_mut();
    for (name, value) in [
        (header::ACCESS_CONTROL_ALLOW_METHODS, "GET, HEAD, POST"),
        // All of them; a star leaves out the one for keys.
        (header::ACCESS_CONTROL_ALLOW_HEADERS, "*, authorization"),
        (header::ACCESS_CONTROL_MAX_AGE, REMEMBER),
        (
            header::VARY,
            "access-control-request-method, access-control-request-headers",
        ),
    ] {
        answer.insert(name, HeaderValue::from_static(value));
    }
    allow(origins, headers.get(header::ORIGIN), answer);
    Some(response)
}

/// Lets the pages that may read an answer do so, with all its headers. Where all may, every answer says so: a cache
/// may keep the answer to a request without an origin for pages.
pub(super) fn allow(origins: &Origins, origin: Option<&HeaderValue>, answer: &mut HeaderMap) {
    let allowed = if *origins == Origins::All {
        Some(ALL)
    } else {
        vary::on(answer, vary::ORIGIN);
        origin.and_then(|origin| origins.allowed(origin))
    };
    let Some(allowed) = allowed else {
        return;
    };
    answer.insert(header::ACCESS_CONTROL_ALLOW_ORIGIN, allowed);
    answer.insert(header::ACCESS_CONTROL_EXPOSE_HEADERS, ALL);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn origins_are_all_or_listed() {
        let page = HeaderValue::from_static("https://A.example");
        assert_eq!(Origins::read(" * "), Origins::All);
        assert_eq!(Origins::All.allowed(&page).expect("all"), "*");
        let listed = Origins::read("https://a.example, http://localhost:3000");
        assert_eq!(listed.allowed(&page).expect("listed"), page);
        let other = HeaderValue::from_static("https://b.example");
        assert_eq!(listed.allowed(&other), None);
        assert_eq!(Origins::read("").allowed(&page), None);
    }
}
