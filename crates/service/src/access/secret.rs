//! Keys as clients have them, and as the daemon keeps them.
//!
//! A key is 256 random bits, so it cannot be guessed: a slow, salted hash, which protects
//! passwords that people choose, would only slow down every request. What is kept is the BLAKE3 hash,
//! from which no key can be found either.

use std::fmt::Write as _;

use strew_error::KEY_PREFIX;

/// The bytes of randomness in a key: twice the number needed.
const RANDOM_BYTES: usize = 32;

/// The hash of a key. Comparing two takes the same time wherever they differ.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Hashed(blake3::Hash);

impl Hashed {
    pub fn of(key: &[u8]) -> Self {
        Self(blake3::hash(key))
    }

    /// From 64 hexadecimal digits.
    pub fn read(text: &str) -> Option<Self> {
        blake3::Hash::from_hex(text).ok().map(Self)
    }
}

impl std::fmt::Debug for Hashed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Hashed(..)")
    }
}

impl std::fmt::Display for Hashed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.to_hex().fmt(f)
    }
}

/// A new key for its holder, and the hash that the daemon keeps.
pub fn new_key() -> Result<(String, Hashed), getrandom::Error> {
    let mut random = [0; RANDOM_BYTES];
    getrandom::fill(&mut random)?;
    let mut key = KEY_PREFIX.to_owned();
    for byte in random {
        let _ = write!(key, "{byte:02x}");
    }
    let hashed = Hashed::of(key.as_bytes());
    Ok((key, hashed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_long_unlike_and_known_by_their_hash_alone() {
        let (one, hashed) = new_key().expect("random numbers");
        let (other, _) = new_key().expect("random numbers");
        assert_ne!(one, other);
        assert_eq!(one.len(), KEY_PREFIX.len() + 64);
        assert_eq!(Hashed::of(one.as_bytes()), hashed);
        assert_eq!(Hashed::read(&hashed.to_string()), Some(hashed));
        assert!(Hashed::of(other.as_bytes()) != hashed);
        assert!(!format!("{hashed:?}").contains(&hashed.to_string()));
    }
}
