//! Pairs of integers, as flags have them: `2,1`, and lists of them: `2,1 3,3`.

use std::str::FromStr;

use anyhow::{Context as _, anyhow};

/// Two integers joined by a comma.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pair<T>(pub(super) [T; 2]);

impl<T: FromStr> FromStr for Pair<T> {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> anyhow::Result<Self> {
        let refused = || anyhow!("`{text}` must be two integers joined by a comma, such as 2,1");
        let (x, y) = text.split_once(',').with_context(refused)?;
        let integer = |text: &str| text.trim().parse().map_err(|_| refused());
        Ok(Self([integer(x)?, integer(y)?]))
    }
}

/// A list of offsets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Offsets(Vec<(i64, i64)>);

impl Offsets {
    pub(super) fn as_slice(&self) -> &[(i64, i64)] {
        &self.0
    }
}

impl FromStr for Offsets {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> anyhow::Result<Self> {
        let pairs = text.split_whitespace().map(str::parse::<Pair<i64>>);
        let pairs = pairs.map(|pair| pair.map(|Pair([x, y])| (x, y)));
        Ok(Self(pairs.collect::<anyhow::Result<_>>()?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_pairs_are_read() {
        let read = |text: &str| text.parse::<Offsets>().map(|offsets| offsets.0);
        assert_eq!(read("2,1  -3,0").expect("valid"), [(2, 1), (-3, 0)]);
        assert_eq!(read("").expect("valid"), []);
        for bad in ["2", "2,", "2,1,3", "2,x", "1.5,2", "99999999999999999999,0"] {
            assert!(read(bad).is_err(), "{bad}");
        }
    }
}
