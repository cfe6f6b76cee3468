//! The strength of the warp.

use crate::error::{Error, ErrorKind, number};

/// The strength of the warp: 0 is none, 1 the measured default.
///
/// ```
/// use strew_core::Warp;
///
/// assert_eq!(Warp::new(0.5)?.strength(), 0.5);
/// assert!(Warp::new(2.5).is_err());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Warp {
    /// In units of 1/256.
    strength: u16,
}

impl Warp {
    /// No warp.
    pub const OFF: Self = Self { strength: 0 };
    /// The default strength: the best trade between isotropy and distances.
    pub const ON: Self = Self { strength: 256 };
    /// The greatest strength.
    pub const MAX_STRENGTH: f64 = 2.0;

    /// A warp of a strength, rounded to 1/256.
    ///
    /// # Errors
    /// [`ErrorKind::Warp`] outside 0 to [`MAX_STRENGTH`](Self::MAX_STRENGTH) and for NaN.
    ///
    /// ```
    /// use strew_core::{ErrorKind, Warp};
    ///
    /// assert_eq!((Warp::new(0.0)?, Warp::new(1.0)?), (Warp::OFF, Warp::ON));
    /// assert_eq!(Warp::new(-0.1).unwrap_err().kind(), ErrorKind::Warp);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn new(strength: f64) -> Result<Self, Error> {
        if (0.0..=Self::MAX_STRENGTH).contains(&strength) {
            Ok(Self {
                strength: libm::round(strength * 256.0) as u16,
            })
        } else {
            let allowed = alloc::format!("a number from 0 (off) to {}", Self::MAX_STRENGTH);
            Err(Error::new(
                ErrorKind::Warp,
                "warp",
                number(strength),
                allowed,
            ))
        }
    }

    /// The strength, a multiple of 1/256.
    ///
    /// ```
    /// use strew_core::Warp;
    ///
    /// assert_eq!(Warp::ON.strength(), 1.0);
    /// assert_eq!(Warp::new(0.3)?.strength(), 77.0 / 256.0);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn strength(self) -> f64 {
        f64::from(self.strength) / 256.0
    }

    /// Whether points stay where the table puts them.
    ///
    /// ```
    /// use strew_core::Warp;
    ///
    /// assert!(Warp::OFF.is_off() && !Warp::ON.is_off());
    /// // Rounding to 1/256 turns a tiny strength off.
    /// assert!(Warp::new(0.001)?.is_off());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn is_off(self) -> bool {
        self.strength == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strengths_are_checked() {
        assert_eq!(Warp::new(1.0), Ok(Warp::ON));
        assert_eq!(Warp::new(0.0), Ok(Warp::OFF));
        for bad in [-0.1, 2.1, f64::NAN, f64::INFINITY] {
            assert!(Warp::new(bad).is_err());
        }
    }
}
