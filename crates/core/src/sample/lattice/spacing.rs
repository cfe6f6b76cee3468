//! The mean spacing of points.

use crate::error::{Error, ErrorKind, exponential, number};

/// The mean spacing of points in world units: density^−½.
///
/// ```
/// use strew_core::Spacing;
///
/// assert_eq!(Spacing::from_density(4.0)?, Spacing::new(0.5)?);
/// assert!(Spacing::new(f64::NAN).is_err());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Spacing(f64);

impl Spacing {
    /// A mean spacing of one world unit.
    pub const ONE: Self = Self(1.0);
    /// The least spacing.
    pub const MIN: f64 = 1e-100;
    /// The greatest spacing.
    pub const MAX: f64 = 1e100;
    /// The least density.
    pub const MIN_DENSITY: f64 = 1e-200;
    /// The greatest density.
    pub const MAX_DENSITY: f64 = 1e200;

    /// A mean spacing in world units, from [`MIN`](Self::MIN) to [`MAX`](Self::MAX).
    ///
    /// # Errors
    /// [`ErrorKind::Spacing`] outside that range and for NaN.
    pub fn new(spacing: f64) -> Result<Self, Error> {
        let (min, max) = (Self::MIN, Self::MAX);
        if (min..=max).contains(&spacing) {
            return Ok(Self(spacing));
        }
        Err(out_of_range(
            ErrorKind::Spacing,
            "spacing",
            spacing,
            [min, max],
        ))
    }

    /// The spacing of a density in points per world unit squared: 1/√density, from
    /// [`MIN_DENSITY`](Self::MIN_DENSITY) to [`MAX_DENSITY`](Self::MAX_DENSITY).
    ///
    /// # Errors
    /// [`ErrorKind::Density`] outside that range and for NaN.
    pub fn from_density(density: f64) -> Result<Self, Error> {
        Self::of_density(density, 2)
    }

    /// The spacing of a density in the plane or in space.
    pub(crate) fn of_density(density: f64, dimensions: u32) -> Result<Self, Error> {
        let (min, max) = (Self::MIN_DENSITY, Self::MAX_DENSITY);
        if !(min..=max).contains(&density) {
            return Err(out_of_range(
                ErrorKind::Density,
                "density",
                density,
                [min, max],
            ));
        }
        // All operations round to nearest, so the spacing is the same on every machine. At the
        // ends of the range it may round past them.
        let spacing = match dimensions {
            2 => 1.0 / libm::sqrt(density),
            _ => 1.0 / libm::cbrt(density),
        };
        Ok(Self(spacing.clamp(Self::MIN, Self::MAX)))
    }

    /// The spacing in world units.
    #[must_use]
    pub const fn get(self) -> f64 {
        self.0
    }

    /// The density in points per world unit squared.
    #[must_use]
    pub fn density(self) -> f64 {
        1.0 / (self.0 * self.0)
    }
}

/// The error of a number outside its range.
fn out_of_range(kind: ErrorKind, name: &'static str, value: f64, range: [f64; 2]) -> Error {
    let [min, max] = range.map(exponential);
    let allowed = alloc::format!("a number from {min} to {max}");
    Error::new(kind, name, number(value), allowed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn out_of_range_is_refused() {
        for bad in [
            0.0,
            -1.0,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            1e300,
            1e-300,
        ] {
            assert!(Spacing::new(bad).is_err(), "{bad}");
            assert!(Spacing::from_density(bad).is_err(), "{bad}");
        }
        assert_eq!(Spacing::from_density(4.0).map(Spacing::get), Ok(0.5));
        assert!(Spacing::from_density(Spacing::MAX_DENSITY).is_ok());
    }
}
