//! How densely points lie.

/// The mean spacing of points in world units: density^−½.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Spacing(f64);

/// A spacing or density that is not allowed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpacingError {
    /// The spacing is not a number within the limits.
    #[error("spacing is {0}; it must be a number from {min:e} to {max:e}", min = Spacing::MIN, max = Spacing::MAX)]
    Spacing(f64),
    /// The density is not a number within the limits.
    #[error("density is {0}; it must be a number from {min:e} to {max:e}", min = Spacing::MIN_DENSITY, max = Spacing::MAX_DENSITY)]
    Density(f64),
}

impl Spacing {
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
    /// [`SpacingError::Spacing`] outside that range or for NaN.
    pub fn new(spacing: f64) -> Result<Self, SpacingError> {
        if (Self::MIN..=Self::MAX).contains(&spacing) {
            Ok(Self(spacing))
        } else {
            Err(SpacingError::Spacing(spacing))
        }
    }

    /// The spacing of a density in points per world unit squared: 1/√density, from
    /// [`MIN_DENSITY`](Self::MIN_DENSITY) to [`MAX_DENSITY`](Self::MAX_DENSITY).
    ///
    /// # Errors
    /// [`SpacingError::Density`] outside that range or for NaN.
    pub fn from_density(density: f64) -> Result<Self, SpacingError> {
        if (Self::MIN_DENSITY..=Self::MAX_DENSITY).contains(&density) {
            // Both operations round to nearest, so every machine gets the same spacing; at the
            // very ends of the range it may round past them.
            Ok(Self(
                (1.0 / libm::sqrt(density)).clamp(Self::MIN, Self::MAX),
            ))
        } else {
            Err(SpacingError::Density(density))
        }
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
