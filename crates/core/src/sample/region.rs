//! Regions of the plane.

use core::fmt;

/// A half-open box in world coordinates: min ≤ p < max along both axes. It may be empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    min: [f64; 2],
    max: [f64; 2],
}

/// Why two corners are not a region.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegionError {
    /// A coordinate is NaN or infinite.
    #[error("{corner} is {value}; it must be a finite number")]
    NotFinite {
        /// Which coordinate.
        corner: Corner,
        /// Its value.
        value: f64,
    },
    /// The upper bound is below the lower one.
    #[error("{corner} is {value}, below the lower bound {lower}; it must not be less")]
    Reversed {
        /// Which coordinate: `MaxX` or `MaxY`.
        corner: Corner,
        /// Its value.
        value: f64,
        /// The lower bound on the same axis.
        lower: f64,
    },
}

/// One of the four numbers of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// The least x.
    MinX,
    /// The least y.
    MinY,
    /// The bound of x.
    MaxX,
    /// The bound of y.
    MaxY,
}

impl Corner {
    /// Its name in queries: `min_x`, `min_y`, `max_x`, `max_y`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::MinX => "min_x",
            Self::MinY => "min_y",
            Self::MaxX => "max_x",
            Self::MaxY => "max_y",
        }
    }
}

impl fmt::Display for Corner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Region {
    /// The box from `min` (included) to `max` (excluded).
    ///
    /// # Errors
    /// [`RegionError`] unless all four are finite and max ≥ min along both axes.
    pub fn new(min: [f64; 2], max: [f64; 2]) -> Result<Self, RegionError> {
        let named = [
            (Corner::MinX, min[0]),
            (Corner::MinY, min[1]),
            (Corner::MaxX, max[0]),
            (Corner::MaxY, max[1]),
        ];
        if let Some(&(corner, value)) = named.iter().find(|(_, value)| !value.is_finite()) {
            return Err(RegionError::NotFinite { corner, value });
        }
        for (corner, lower, value) in [
            (Corner::MaxX, min[0], max[0]),
            (Corner::MaxY, min[1], max[1]),
        ] {
            if value < lower {
                return Err(RegionError::Reversed {
                    corner,
                    value,
                    lower,
                });
            }
        }
        Ok(Self { min, max })
    }

    /// The box between corners that are known to be finite and in order.
    pub(super) const fn between(min: [f64; 2], max: [f64; 2]) -> Self {
        Self { min, max }
    }

    /// The lower corner, included.
    #[must_use]
    pub const fn min(&self) -> [f64; 2] {
        self.min
    }

    /// The upper corner, excluded.
    #[must_use]
    pub const fn max(&self) -> [f64; 2] {
        self.max
    }

    /// What lies in both boxes; without extent if nothing does.
    #[must_use]
    pub fn and(&self, other: Self) -> Self {
        let [min, max] = [
            [0, 1].map(|i| self.min[i].max(other.min[i])),
            [0, 1].map(|i| self.max[i].min(other.max[i])),
        ];
        let reversed = (0..2).any(|i| max[i] < min[i]);
        Self {
            min,
            max: if reversed { min } else { max },
        }
    }

    /// Whether all points of another box, its upper sides included, are inside or none.
    pub(super) fn within(&self, other: &Self) -> Option<bool> {
        let (min, max) = (other.min, other.max);
        if (0..2).any(|i| max[i] < self.min[i] || self.max[i] <= min[i]) || self.is_empty() {
            Some(false)
        } else {
            (self.contains(min) && self.contains(max)).then_some(true)
        }
    }

    /// Whether the box has no extent along an axis.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.max[0] <= self.min[0] || self.max[1] <= self.min[1]
    }

    /// Whether a point lies inside.
    #[must_use]
    pub fn contains(&self, p: [f64; 2]) -> bool {
        (0..2).all(|i| self.min[i] <= p[i] && p[i] < self.max[i])
    }
}
