//! Which pages and which hosts requests may come from and be for.
//!
//! Pages of other origins are clients (the Fetch standard's CORS protocol) without credentials that browsers add by
//! themselves: keys are headers that a page has to know.
//!
//! Hosts are checked against DNS rebinding: a page whose name leads to another address a moment later is of the same
//! origin as a daemon on its reader's machine, and could use and read it. Such a page has a name with a dot: no public
//! server of names knows others. So a daemon on loopback takes requests for addresses, `localhost`, names without a dot
//! (what a proxy on the same machine calls it) and the host of `http.public_url` alone. Elsewhere it does not know its
//! names: proxies, containers and clusters choose them.

use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr};

use http::{HeaderMap, HeaderValue, Method, StatusCode, header, uri::Authority};
use strew_error::{Denied, Error};

use super::negotiate::{BY_ORIGIN, vary};
use crate::body::{Body, Request, Response};

const ALL: HeaderValue = HeaderValue::from_static("*");

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Origins {
    All,
    Some(Vec<String>),
}

impl Origins {
    /// From a setting: `*`, or origins with spaces or commas between them.
    pub(super) fn read(text: &str) -> Self {
        if text.trim() == "*" {
            return Self::All;
        }
        let origins = text.split([' ', ',']).filter(|origin| !origin.is_empty());
        Self::Some(origins.map(str::to_ascii_lowercase).collect())
    }

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
        vary(answer, BY_ORIGIN);
        origin.and_then(|origin| origins.allowed(origin))
    };
    let Some(allowed) = allowed else {
        return;
    };
    answer.insert(header::ACCESS_CONTROL_ALLOW_ORIGIN, allowed);
    answer.insert(header::ACCESS_CONTROL_EXPOSE_HEADERS, ALL);
}

#[derive(Clone, Debug)]
pub(super) struct Hosts {
    is_on_loopback: bool,
    /// Host and port of `http.public_url`, if it is set.
    public: Option<Authority>,
}

impl Hosts {
    pub(super) fn new(public_url: &str, is_on_loopback: bool) -> Self {
        let public = public_url.split_once("://");
        Self {
            is_on_loopback,
            public: public.and_then(|(_, authority)| authority.parse().ok()),
        }
    }

    /// Why a request is refused whatever it is: a host that it is for is foreign.
    pub(super) fn refusal(&self, request: &Request) -> Option<Error> {
        if !self.is_on_loopback {
            return None;
        }
        let foreign = |text: &[u8]| {
            let host = String::from_utf8_lossy(text).chars().take(100).collect();
            Error::from(Denied::ForeignHost { host })
        };
        let authority = request.uri().authority();
        let authority = authority.filter(|authority| !self.has_name(authority.host()));
        if let Some(authority) = authority {
            return Some(foreign(authority.as_str().as_bytes()));
        }
        let lines = request.headers().get_all(header::HOST).iter();
        let mut lines = lines.map(HeaderValue::as_bytes);
        // Those of requests for no host are empty.
        lines
            .find(|text| !text.is_empty() && !self.has_authority(text))
            .map(foreign)
    }

    /// Whether a page is the daemon's own: of its public address, or of the host that the request is for, where no
    /// other page can have that name.
    pub(super) fn is_own(&self, origin: &HeaderValue, request: &Request) -> bool {
        let origin = origin.to_str().ok().and_then(|of| of.split_once("://"));
        let Some((_, origin)) = origin else {
            return false;
        };
        let public = self.public.as_ref();
        if public.is_some_and(|public| public.as_str().eq_ignore_ascii_case(origin)) {
            return true;
        }
        let host = request.headers().get(header::HOST);
        let host = host.map(HeaderValue::as_bytes);
        let authority = request.uri().authority().map(|of| of.as_str().as_bytes());
        let Some(host) = host.or(authority) else {
            return false;
        };
        let site = request.headers().get("sec-fetch-site");
        let is_same = site.is_some_and(|site| site == "same-origin");
        let has_any_name = !self.is_on_loopback && public.is_none();
        (is_same || origin.as_bytes().eq_ignore_ascii_case(host))
            && (has_any_name || self.has_authority(host))
    }

    /// Whether a host, perhaps with a port, is the daemon's.
    fn has_authority(&self, text: &[u8]) -> bool {
        let text = str::from_utf8(text).unwrap_or_default();
        text.parse::<SocketAddr>().is_ok()
            || Authority::try_from(text).is_ok_and(|authority| self.has_name(authority.host()))
    }

    /// Whether a host is the daemon's whatever a server of names says.
    fn has_name(&self, host: &str) -> bool {
        let inner = host
            .strip_prefix('[')
            .and_then(|host| host.strip_suffix(']'));
        if let Some(inner) = inner {
            return inner.parse::<Ipv6Addr>().is_ok();
        }
        let host = host.strip_suffix('.').unwrap_or(host).to_ascii_lowercase();
        let public = self.public.as_ref();
        !host.contains(['.', ':'])
            || host.ends_with(".localhost")
            || host.parse::<Ipv4Addr>().is_ok()
            || public.is_some_and(|public| public.host().eq_ignore_ascii_case(&host))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Body;

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

    fn request(uri: &str, headers: &[(&'static str, &str)]) -> Request {
        let mut request = http::Request::builder().uri(uri);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        request.body(Body::empty()).expect("a request")
    }

    #[test]
    fn on_loopback_names_that_others_can_have_are_foreign() {
        let here = Hosts::new("https://points.example", true);
        let there = Hosts::new("", false);
        for (host, is_ours) in [
            ("127.0.0.1:8080", true),
            ("10.0.0.7", true),
            ("[::1]:8080", true),
            ("[::ffff:127.0.0.1]", true),
            ("localhost:8080", true),
            ("LOCALHOST.", true),
            ("strew.localhost:1", true),
            ("Points.Example:8443", true),
            ("", true),
            ("strew", true),
            ("points_1:8080", true),
            ("evil.example", false),
            ("evil.example:8080", false),
            ("points.example.evil.example", false),
            ("127.0.0.1.evil.example:8080", false),
            ("localhost.evil.example", false),
            ("not.localhost.evil", false),
            ("127.0.0.1@evil.example", false),
            ("[evil.example]", false),
            ("a b", false),
        ] {
            let asked = request("/", &[("host", host)]);
            assert_eq!(here.refusal(&asked).is_none(), is_ours, "{host}");
            assert!(there.refusal(&asked).is_none(), "{host}");
        }
        // HTTP/2 and absolute addresses have it elsewhere.
        for (uri, host) in [
            ("http://evil.example:8080/", ""),
            ("http://evil.example:8080/", "127.0.0.1"),
            ("http://127.0.0.1/", "evil.example"),
        ] {
            let asked = request(uri, &[("host", host)]);
            assert!(here.refusal(&asked).is_some(), "{uri} {host}");
        }
    }

    #[test]
    fn own_pages_have_a_name_that_only_the_daemon_has() {
        let cases = [
            (
                "http://evil.example:80",
                "evil.example:80",
                [false, true, false],
            ),
            ("http://127.0.0.1:80", "127.0.0.1:80", [true, true, true]),
            ("http://localhost:80", "localhost:80", [true, true, true]),
            ("http://localhost:81", "localhost:80", [false, false, false]),
            ("https://points.example", "strew:8080", [false, false, true]),
            (
                "https://points.example:1",
                "strew:8080",
                [false, false, false],
            ),
        ];
        let hosts = [
            Hosts::new("", true),
            Hosts::new("", false),
            Hosts::new("https://points.example", false),
        ];
        for (origin, host, expected) in cases {
            let (page, asked) = (
                HeaderValue::from_static(origin),
                request("/", &[("host", host)]),
            );
            let own = [0, 1, 2].map(|which: usize| hosts[which].is_own(&page, &asked));
            assert_eq!(own, expected, "{origin} {host}");
        }
        let claims = [("host", "evil.example"), ("sec-fetch-site", "same-origin")];
        let origin = HeaderValue::from_static("http://evil.example");
        assert!(!hosts[0].is_own(&origin, &request("/", &claims)));
        assert!(hosts[1].is_own(&origin, &request("/", &claims)));
    }
}
