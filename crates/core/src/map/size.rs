//! Names for the sizes of maps.

use core::{fmt, str::FromStr};

use super::MAX_RADIUS;

/// The size of a neighborhood map, by its half-width R. As text `s` (R = 49), `m` (R = 100), `l`
/// (R = 200), or `r` and the number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Size(u32);

/// A text that is not the size of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a map size is s (R = 49), m (R = 100), l (R = 200), or r and R from 0 to {MAX_RADIUS}")]
pub struct SizeError;

impl Size {
    /// R = 49: about 15 mean spacings, 63 intervals at the default α.
    pub const S: Self = Self(49);
    /// R = 100.
    pub const M: Self = Self(100);
    /// R = 200.
    pub const L: Self = Self(200);

    /// The size of a map of half-width R.
    #[must_use]
    pub const fn of_radius(radius: u32) -> Self {
        Self(radius)
    }

    /// The half-width R, in grid units.
    #[must_use]
    pub const fn radius(self) -> u32 {
        self.0
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::S => f.write_str("s"),
            Self::M => f.write_str("m"),
            Self::L => f.write_str("l"),
            Self(radius) => write!(f, "r{radius}"),
        }
    }
}

impl FromStr for Size {
    type Err = SizeError;

    fn from_str(text: &str) -> Result<Self, SizeError> {
        match text {
            "s" => Ok(Self::S),
            "m" => Ok(Self::M),
            "l" => Ok(Self::L),
            _ => text
                .strip_prefix('r')
                .filter(|digits| digits.bytes().all(|c| c.is_ascii_digit()))
                .and_then(|digits| digits.parse().ok())
                .filter(|&radius| radius <= MAX_RADIUS)
                .map(Self)
                .ok_or(SizeError),
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;

    #[test]
    fn names_read_back() {
        for radius in [0, 20, 49, 100, 200, MAX_RADIUS] {
            let size = Size::of_radius(radius);
            assert_eq!(size.to_string().parse(), Ok(size));
        }
        assert_eq!("r49".parse(), Ok(Size::S));
        for bad in ["", "S", "xl", "r", "r-1", "r+1", "r5000", "49"] {
            assert_eq!(bad.parse::<Size>(), Err(SizeError), "{bad}");
        }
    }
}
