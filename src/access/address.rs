//! Whose address a request comes from, where proxies stand between.
//!
//! `X-Forwarded-For` is a list to which each proxy appends whom it heard the request from. Anyone can
//! send one, so it is read from its end, and only as far as those who wrote it are trusted.

use std::net::IpAddr;

/// Networks, such as those of proxies.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Networks {
    networks: Vec<(IpAddr, u32)>,
}

/// What a list of networks is.
pub const NETWORKS: &str =
    "addresses (10.0.0.1) or networks (10.0.0.0/8, fd00::/8) with spaces or commas between them";

impl Networks {
    /// Reads a list; gives what is no network.
    ///
    /// # Errors
    /// The first part that is neither an address nor a network.
    pub fn read(text: &str) -> Result<Self, String> {
        let parts = text.split([' ', ',']).filter(|part| !part.is_empty());
        let network = |part: &str| {
            let (address, length) = match part.split_once('/') {
                Some((address, length)) => (address, Some(length)),
                None => (part, None),
            };
            let address: IpAddr = address.parse().ok()?;
            let bits = if address.is_ipv4() { 32 } else { 128 };
            let length = match length {
                Some(text) => text.parse().ok().filter(|length| *length <= bits)?,
                None => bits,
            };
            Some((address, length))
        };
        let read = parts.map(|part| network(part).ok_or_else(|| part.to_owned()));
        Ok(Self {
            networks: read.collect::<Result<_, _>>()?,
        })
    }

    /// Whether one of the networks has an address.
    #[must_use]
    pub fn contains(&self, address: IpAddr) -> bool {
        let address = address.to_canonical();
        self.networks.iter().any(|&(network, length)| {
            let (ours, theirs, bits) = match (network, address) {
                (IpAddr::V4(a), IpAddr::V4(b)) => (a.to_bits().into(), b.to_bits().into(), 32),
                (IpAddr::V6(a), IpAddr::V6(b)) => (a.to_bits(), b.to_bits(), 128),
                _ => return false,
            };
            let differs: u128 = ours ^ theirs;
            differs.checked_shr(bits - length).unwrap_or(0) == 0
        })
    }

    /// The client behind a peer: the last one whom a trusted proxy names and that is no such proxy
    /// itself. `lines` are those of `X-Forwarded-For`, in their order.
    pub fn client<'a>(
        &self,
        peer: IpAddr,
        lines: impl DoubleEndedIterator<Item = &'a [u8]>,
    ) -> IpAddr {
        let mut client = peer.to_canonical();
        if !self.contains(client) {
            return client;
        }
        let named = lines
            .rev()
            .flat_map(|line| line.rsplit(|&byte| byte == b','));
        for name in named {
            // What is not an address was not written by a proxy that is to be trusted.
            let Some(address) = read(name) else { break };
            client = address;
            if !self.contains(client) {
                break;
            }
        }
        client
    }
}

/// An address, perhaps with a port.
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
        networks.client(peer, lines).to_string()
    }

    #[test]
    fn nobody_is_believed_who_is_not_trusted() {
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
    fn proxies_in_a_row_are_passed() {
        let lines = ["203.0.113.7", "198.51.100.1, 10.9.9.9", "10.8.8.8:4711"];
        assert_eq!(client("10.0.0.0/8", "10.1.2.3", &lines), "198.51.100.1");
        assert_eq!(client("10.0.0.0/8", "10.1.2.3", &[]), "10.1.2.3");
        assert_eq!(client("10.0.0.0/8", "10.1.2.3", &["10.4.4.4"]), "10.4.4.4");
        let broken = ["198.51.100.1, nobody, 10.9.9.9"];
        assert_eq!(client("10.0.0.0/8", "10.1.2.3", &broken), "10.9.9.9");
        assert_eq!(
            client("fd00::/8 ::1", "::1", &["[2001:db8::5]:80"]),
            "2001:db8::5"
        );
    }

    #[test]
    fn networks_read_or_say_what_does_not() {
        for text in [
            "10.0.0.0/33",
            "fd00::/129",
            "proxy",
            "10.0.0.1/",
            "10.0.0.1/-1",
        ] {
            assert_eq!(
                Networks::read(&format!("::1, {text}")),
                Err(text.to_owned())
            );
        }
        let all = Networks::read("0.0.0.0/0").expect("valid");
        assert!(all.contains("192.0.2.1".parse().expect("valid")));
        assert!(!all.contains("::1".parse().expect("valid")));
    }
}
