//! The address of a daemon.

use std::{
    fmt,
    net::{IpAddr, SocketAddr},
};

use anyhow::{anyhow, bail};
use http::Uri;

/// A scheme, a host and a port. Its text is a URL without a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Address {
    pub(crate) is_tls: bool,
    /// The name or the IP address, of IPv6 without brackets.
    pub(crate) host: String,
    pub(crate) port: u16,
}

impl Address {
    /// Reads the value of `--url`.
    pub(crate) fn read(url: &str) -> anyhow::Result<Self> {
        let read = || {
            let url: Uri = url.parse().ok()?;
            let (is_tls, usual) = match url.scheme_str()? {
                "http" => (false, 80),
                "https" => (true, 443),
                _ => return None,
            };
            let authority = url.authority()?;
            let (host, port) = (authority.host(), authority.port_u16());
            // Neither a user nor a port out of range.
            let is_plain = authority.as_str().len() == host.len() || {
                let port = authority.as_str().strip_prefix(host)?.strip_prefix(':')?;
                port.parse::<u16>().is_ok()
            };
            let is_bare = url.path() == "/" && url.query().is_none();
            (is_plain && is_bare && !host.is_empty()).then(|| Self {
                is_tls,
                host: host.trim_matches(['[', ']']).into(),
                port: port.unwrap_or(usual),
            })
        };
        read().ok_or_else(|| anyhow!("--url {url}: allowed: http://host:port or https://host:port"))
    }

    /// The address at which this machine reaches a daemon that listens there.
    pub(crate) fn of_listener(listen: SocketAddr, is_tls: bool) -> anyhow::Result<Self> {
        if listen.port() == 0 {
            bail!(
                "server.listen = {listen}: the port is only known to the daemon; name it with --url"
            );
        }
        let host = match listen.ip() {
            IpAddr::V4(ip) if ip.is_unspecified() => "127.0.0.1".into(),
            IpAddr::V6(ip) if ip.is_unspecified() => "::1".into(),
            ip => ip.to_string(),
        };
        Ok(Self {
            is_tls,
            host,
            port: listen.port(),
        })
    }

    /// Whether the host is this machine by its name.
    pub(crate) fn is_here(&self) -> bool {
        let ip = self.host.parse::<IpAddr>();
        self.host == "localhost" || ip.is_ok_and(|ip| ip.is_loopback())
    }

    /// The host and the port, as the header `host` has them.
    pub(super) fn authority(&self) -> String {
        match self.host.contains(':') {
            true => format!("[{}]:{}", self.host, self.port),
            false => format!("{}:{}", self.host, self.port),
        }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scheme = if self.is_tls { "https" } else { "http" };
        write!(f, "{scheme}://{}", self.authority())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_url_is_a_scheme_a_host_and_a_port() {
        for (url, expected, host) in [
            (
                "http://127.0.0.1:8080",
                "http://127.0.0.1:8080",
                "127.0.0.1",
            ),
            (
                "http://127.0.0.1:8080/",
                "http://127.0.0.1:8080",
                "127.0.0.1",
            ),
            ("http://[::1]:8080", "http://[::1]:8080", "::1"),
            ("http://strew", "http://strew:80", "strew"),
            ("https://strew", "https://strew:443", "strew"),
            ("https://strew:8443/", "https://strew:8443", "strew"),
        ] {
            let address = Address::read(url).expect(url);
            assert_eq!((&*address.to_string(), &*address.host), (expected, host));
        }
        for url in [
            "",
            "strew",
            "ftp://a:1",
            "http://",
            "http://:80",
            "http://a/readyz",
            "http://a/?b",
            "http://u@a",
            "http://u@a:80",
            "http://a:99999",
            "http://a b",
        ] {
            let error = Address::read(url).expect_err(url).to_string();
            assert!(error.contains("allowed: http://host:port"), "{error}");
        }
    }

    #[test]
    fn a_daemon_that_listens_everywhere_is_reached_here() {
        let of = |text: &str| {
            let listen = text.parse().expect("an address");
            Address::of_listener(listen, false).map(|address| address.authority())
        };
        assert_eq!(of("0.0.0.0:80").expect("a port"), "127.0.0.1:80");
        assert_eq!(of("[::]:80").expect("a port"), "[::1]:80");
        assert_eq!(of("10.1.2.3:80").expect("a port"), "10.1.2.3:80");
        assert!(of("127.0.0.1:0").is_err());
    }
}
