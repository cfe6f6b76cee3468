//! Cursor tokens: places in an answer, to be handed back.
//!
//! A token holds what it takes to go on without counting again (which set, how many points came before, the lattice
//! address of the next one, the spacing that a count became) and a digest of these with the query it belongs to, so
//! that a token of another query, or a damaged one, is refused and never yields other points.

use std::fmt;

use strew_core::Spacing;
use strew_encode::Mark;
use strew_error::Fault;

const CURSOR: &str = "the cursor of an earlier answer to the same query";

/// A place in the answer to a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Token {
    pub set: u16,
    /// The number of points in the sets before it.
    pub before: u128,
    pub mark: Mark,
    /// The spacing, if the amount is a count: to find it again would take counting.
    pub spacing: Option<Spacing>,
    seal: [u8; SEAL],
}

const SEAL: usize = 12;
/// The first byte of a token without the parts below.
const PLAIN: u8 = 1;
/// The bit of a token with a spacing.
const SPACED: u8 = 1;
/// The bit of one whose third coordinate is not 0.
const IN_SPACE: u8 = 2;

impl Token {
    /// The token of a place in the answer to the query with this identity.
    pub fn new(
        identity: &[u8; 32],
        set: u16,
        before: u128,
        mark: Mark,
        spacing: Option<Spacing>,
    ) -> Self {
        let mut token = Self {
            set,
            before,
            mark,
            spacing,
            seal: [0; SEAL],
        };
        token.seal = token.sealed(identity);
        token
    }

    /// Reads a token; that it is of the right query is for [`check`](Self::check).
    pub(super) fn parse(text: &str) -> Result<Self, Fault> {
        let fault = || Fault::new("cursor", text, "not a cursor", CURSOR);
        let bytes = from_hex(text).ok_or_else(fault)?;
        let mut rest = bytes.as_slice();
        let mut read = || -> Option<Self> {
            let [version] = take(&mut rest)?;
            let parts = version.checked_sub(PLAIN)?;
            if parts > SPACED + IN_SPACE {
                return None;
            }
            Some(Self {
                set: u16::from_le_bytes(take(&mut rest)?),
                before: u128::from_le_bytes(take(&mut rest)?),
                mark: Mark {
                    offset: u128::from_le_bytes(take(&mut rest)?),
                    total: u128::from_le_bytes(take(&mut rest)?),
                    at: [
                        i64::from_le_bytes(take(&mut rest)?),
                        i64::from_le_bytes(take(&mut rest)?),
                        match parts & IN_SPACE {
                            0 => 0,
                            _ => i64::from_le_bytes(take(&mut rest)?),
                        },
                    ],
                },
                spacing: match parts & SPACED {
                    0 => None,
                    _ => Some(Spacing::new(f64::from_le_bytes(take(&mut rest)?)).ok()?),
                },
                seal: take(&mut rest)?,
            })
        };
        let token = read().ok_or_else(fault)?;
        if rest.is_empty() {
            Ok(token)
        } else {
            Err(fault())
        }
    }

    pub fn check(&self, identity: &[u8; 32]) -> Result<(), Fault> {
        if self.seal == self.sealed(identity) {
            return Ok(());
        }
        let detail = "belongs to another query or to another table";
        Err(Fault::new("cursor", self, detail, CURSOR))
    }

    fn content(&self) -> Vec<u8> {
        let Mark { offset, total, at } = self.mark;
        let [x, y, z] = at;
        let spaced = SPACED * u8::from(self.spacing.is_some());
        let mut bytes = vec![PLAIN + spaced + IN_SPACE * u8::from(z != 0)];
        bytes.extend(self.set.to_le_bytes());
        bytes.extend(self.before.to_le_bytes());
        bytes.extend(offset.to_le_bytes());
        bytes.extend(total.to_le_bytes());
        bytes.extend(x.to_le_bytes());
        bytes.extend(y.to_le_bytes());
        if z != 0 {
            bytes.extend(z.to_le_bytes());
        }
        bytes.extend(self.spacing.iter().flat_map(|s| s.get().to_le_bytes()));
        bytes
    }

    fn sealed(&self, identity: &[u8; 32]) -> [u8; SEAL] {
        let mut hasher = blake3::Hasher::new();
        hasher.update(identity).update(&self.content());
        let mut seal = [0; SEAL];
        hasher.finalize_xof().fill(&mut seal);
        seal
    }
}

impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut bytes = self.content();
        bytes.extend(self.seal);
        bytes.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

fn take<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (first, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*first)
}

fn from_hex(text: &str) -> Option<Vec<u8>> {
    let digit = |c: u8| match c {
        b'0'..=b'9' => Some(c - b'0'),
        b'a'..=b'f' => Some(c - b'a' + 10),
        _ => None,
    };
    let (pairs, []) = text.as_bytes().as_chunks::<2>() else {
        return None;
    };
    let byte = |[high, low]: &[u8; 2]| Some(digit(*high)? << 4 | digit(*low)?);
    pairs.iter().map(byte).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_read_back_and_damage_shows() {
        let mark = |z| Mark {
            offset: 1 << 70,
            total: u128::MAX,
            at: [-5, i64::MAX, z],
        };
        let identity = [7; 32];
        let spaced = Spacing::new(0.25).ok();
        for (z, spacing) in [(0, None), (0, spaced), (-9, None), (-9, spaced)] {
            let token = Token::new(&identity, 3, 99, mark(z), spacing);
            let text = token.to_string();
            let read = Token::parse(&text).expect("whole");
            assert_eq!(read, token);
            assert_eq!(read.check(&identity), Ok(()));
            assert!(read.check(&[8; 32]).is_err());
            for i in 0..text.len() {
                let mut damaged = text.clone().into_bytes();
                damaged[i] = if damaged[i] == b'0' { b'1' } else { b'0' };
                let damaged = String::from_utf8(damaged).expect("digits");
                let refused = Token::parse(&damaged).and_then(|token| token.check(&identity));
                assert!(refused.is_err(), "{i}");
            }
            for bad in [&text[2..], &format!("{text}00")] {
                assert!(Token::parse(bad).is_err(), "{bad}");
            }
        }
        for bad in ["", "0", "00", "01", "02", "03", "04", "05", "zz"] {
            assert!(Token::parse(bad).is_err(), "{bad}");
        }
    }
}
