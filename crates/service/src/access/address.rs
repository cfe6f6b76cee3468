//! The address that a request comes from, also through proxies.
//!
//! `X-Forwarded-For` is a list to which each proxy appends the address of its client. Any client can send
//! one, so it is read from its end, and only while its writers are trusted.

use std::net::{IpAddr, Ipv4Addr};

use strew_config::Networks;

/// The address of all clients that a trusted proxy names by something else, such as `unknown`: they share the limits of
/// one.
const UNKNOWN: IpAddr = IpAddr::V4(Ipv4Addr::UNSPECIFIED);

/// The client behind a peer: the last one whom a trusted proxy names and that is no such proxy
/// itself. `lines` are those of `X-Forwarded-For`, in their order.
pub(super) fn client<'a>(
    proxies: &Networks,
    peer: IpAddr,
    lines: impl DoubleEndedIterator<Item = &'a [u8]>,
) -> IpAddr {
    let mut client = peer.to_canonical();
    if !proxies.contains(client) {
        return client;
    }
    let named = lines
        .rev()
        .flat_map(|line| line.rsplit(|&byte| byte == b','));
    for name in named {
        let Some(address) = read(name) else {
            return UNKNOWN;
        };
        client = address;
        if !proxies.contains(client) {
            break;
        }
    }
    client
}

fn read(name: &[u8]) -> Option<IpAddr> {
    let name = std::str::from_utf8(name).ok()?.trim();
    let bare = name
        .strip_prefix('[')
        .and_then(|rest| rest.strip_suffix(']'));
    let address = bare.unwrap_or(name).parse::<IpAddr>().ok();
    let with_port = || {
        name.parse::<std::net::SocketAddr>()
            .ok()
            .map(|all| all.ip())
    };
    address
        .or_else(with_port)
        .map(|address| address.to_canonical())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn client(trusted: &str, peer: &str, lines: &[&str]) -> String {
        let networks = Networks::read(trusted).expect("networks");
        let lines = lines.iter().map(|line| line.as_bytes());
        let peer = peer.parse().expect("an address");
        super::client(&networks, peer, lines).to_string()
    }

    #[test]
    fn headers_of_untrusted_peers_are_ignored() {
        assert_eq!(client("", "192.0.2.9", &["198.51.100.1"]), "192.0.2.9");
        assert_eq!(
            client("10.0.0.0/8", "192.0.2.9", &["198.51.100.1"]),
            "192.0.2.9"
        );
        let forged = ["203.0.113.7, 198.51.100.1"];
        assert_eq!(client("10.0.0.0/8", "10.1.2.3", &forged), "198.51.100.1");
        assert_eq!(
            client("10.0.0.0/8", "::ffff:10.1.2.3", &forged),
            "198.51.100.1"
        );
    }

    #[test]
    fn clients_without_an_address_are_one_that_is_no_proxy() {
        for broken in [
            "198.51.100.1, nobody, 10.9.9.9",
            "unknown",
            "_hidden",
            "",
            "10.1.2.3:x",
        ] {
            assert_eq!(
                client("10.0.0.0/8", "10.1.2.3", &[broken]),
                "0.0.0.0",
                "{broken}"
            );
        }
    }

    #[test]
    fn proxies_in_a_row_are_passed() {
        let lines = ["203.0.113.7", "198.51.100.1, 10.9.9.9", "10.8.8.8:4711"];
        assert_eq!(client("10.0.0.0/8", "10.1.2.3", &lines), "198.51.100.1");
        assert_eq!(client("10.0.0.0/8", "10.1.2.3", &[]), "10.1.2.3");
        assert_eq!(client("10.0.0.0/8", "10.1.2.3", &["10.4.4.4"]), "10.4.4.4");
        assert_eq!(
            client("fd00::/8 ::1", "::1", &["[2001:db8::5]:80"]),
            "2001:db8::5"
        );
    }
}
