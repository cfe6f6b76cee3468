//! The hosts that requests may be for, against DNS rebinding: a page whose name leads to another address a moment later
//! is of the same origin as a daemon on its reader's machine, and could use and read it.
//!
//! Such a page has a name, with a dot: no public server of names knows others. So a daemon on loopback takes requests for
//! addresses, `localhost`, names without a dot (what a proxy on the same machine calls it) and the host of
//! `http.public_url` alone. Elsewhere it does not know its names: proxies, containers and clusters choose them.

use std::net::{Ipv4Addr, Ipv6Addr};

use http::{HeaderValue, header, uri::Authority};
use strew_error::{Denied, Error};

use crate::body::Request;

/// The names of a daemon.
#[derive(Clone, Debug)]
pub(super) struct Hosts {
    is_on_loopback: bool,
    /// Host and port of `http.public_url`, if it is set.
    public: Option<Authority>,
}

impl Hosts {
    /// Those of a daemon that listens on loopback or elsewhere.
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
        Authority::try_from(text).is_ok_and(|authority| self.has_name(authority.host()))
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
    use crate::body::Body;

    use super::*;

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
