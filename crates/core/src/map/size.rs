//! The sizes of maps and their names.

use core::{fmt, str::FromStr};

use crate::error::{Error, ErrorKind, shown};

/// The largest half-width of a map. At 1024 a table has about 1.7 million vectors; the largest shipped
/// half-width is 200, with 255 intervals at the default α.
pub const MAX_RADIUS: u32 = 1024;

/// The forms of the text of a size.
const ALLOWED: &str = "s (R = 49), m (R = 100), l (R = 200), or r and R from 0 to 1024";

/// Refuses a half-width above [`MAX_RADIUS`].
pub(super) fn check_radius(radius: u32) -> Result<(), Error> {
    if radius <= MAX_RADIUS {
        return Ok(());
    }
    let allowed = alloc::format!("at most {MAX_RADIUS}");
    Err(Error::new(
        ErrorKind::MapSize,
        "map half-width R",
        radius,
        allowed,
    ))
}

/// The size of a neighborhood map, named by its half-width R: `s` (R = 49), `m` (R = 100), `l`
/// (R = 200), or `r` and the number.
///
/// ```
/// use strew_core::map::Size;
///
/// assert_eq!("m".parse::<Size>()?.radius(), 100);
/// assert_eq!(Size::of_radius(64).to_string(), "r64");
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Size(u32);

impl Size {
    /// R = 49: about 15 mean spacings, 63 intervals at the default α.
    pub const S: Self = Self(49);
    /// R = 100.
    pub const M: Self = Self(100);
    /// R = 200.
    pub const L: Self = Self(200);

    /// The size of a map of half-width R, in grid units. Values above [`MAX_RADIUS`] have a size but no map.
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
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
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
                .ok_or_else(|| Error::new(ErrorKind::MapSize, "map size", shown(text), ALLOWED)),
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
            let error = bad.parse::<Size>().expect_err(bad);
            assert_eq!(error.kind(), ErrorKind::MapSize);
        }
    }
}
