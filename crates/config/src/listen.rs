//! Addresses to listen on, in the forms that people write.

use std::net::{IpAddr, Ipv4Addr, SocketAddr, ToSocketAddrs as _};

use serde::{Deserialize, Deserializer, de};

const ALLOWED: &str = "an address and a port (127.0.0.1:8080, [::1]:8080), a name and a port \
                       (localhost:8080), a port on all addresses (:8080), or a port of this machine \
                       alone (8080)";

pub(super) fn read(text: &str) -> Result<SocketAddr, String> {
    let port = |text: &str| text.parse::<u16>().ok();
    let read = || {
        if let Ok(address) = text.parse() {
            return Some(address);
        }
        if let Some(port) = port(text) {
            return Some((IpAddr::from(Ipv4Addr::LOCALHOST), port).into());
        }
        let (name, number) = text.rsplit_once(':')?;
        let number = port(number)?;
        match name {
            "" => Some((IpAddr::from(Ipv4Addr::UNSPECIFIED), number).into()),
            "localhost" => Some((IpAddr::from(Ipv4Addr::LOCALHOST), number).into()),
            name => (name, number).to_socket_addrs().ok()?.next(),
        }
    };
    read().ok_or_else(|| format!("{text:?} is not an address to listen on; allowed: {ALLOWED}"))
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<SocketAddr, D::Error> {
    let text = String::deserialize(from)?;
    read(&text).map_err(|error| de::Error::custom(format!("server.listen: {error}")))
}

#[cfg(test)]
mod tests {
    use super::read;

    #[test]
    fn the_usual_forms_are_read() {
        for (text, expected) in [
            ("127.0.0.1:80", "127.0.0.1:80"),
            ("[::1]:80", "[::1]:80"),
            ("localhost:8080", "127.0.0.1:8080"),
            (":8080", "0.0.0.0:8080"),
            ("8080", "127.0.0.1:8080"),
        ] {
            assert_eq!(read(text), Ok(expected.parse().expect("valid")), "{text}");
        }
        for text in [
            "",
            ":",
            "localhost",
            "1.2.3.4",
            "127.0.0.1:99999",
            "8080:",
            "no where:1",
        ] {
            let error = read(text).expect_err(text);
            assert!(error.contains("localhost:8080"), "{error}");
        }
    }
}
