//! Lists of networks.

use std::net::IpAddr;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Networks {
    networks: Vec<(IpAddr, u32)>,
}

pub const NETWORKS: &str =
    "addresses (10.0.0.1) or networks (10.0.0.0/8, fd00::/8) with spaces or commas between them";

impl Networks {
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
}

#[cfg(test)]
mod tests {
    use super::*;

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
