//! Digests, which name tables.

use core::{fmt, str::FromStr};

use crate::error::{Error, ErrorKind, shown};

/// A BLAKE3 digest: 32 bytes, as text 64 lower-case hexadecimal digits.
///
/// ```
/// use strew_core::table::Digest;
///
/// let digest = Digest::of(b"strew");
/// assert_eq!(digest.to_string().parse::<Digest>()?, digest);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Digest([u8; 32]);

impl Digest {
    /// The BLAKE3 digest of `bytes`.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        Self(*blake3::hash(bytes).as_bytes())
    }

    /// The digest with these bytes.
    #[must_use]
    pub const fn from_bytes(bytes: [u8; 32]) -> Self {
        Self(bytes)
    }

    /// The 32 bytes.
    #[must_use]
    pub const fn as_bytes(&self) -> &[u8; 32] {
        &self.0
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for Digest {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let hash = blake3::Hash::from_hex(text).map_err(|_| {
            Error::new(
                ErrorKind::Digest,
                "digest",
                shown(text),
                "64 hexadecimal digits",
            )
        })?;
        Ok(Self(*hash.as_bytes()))
    }
}
