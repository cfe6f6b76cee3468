//! The share of points that a set keeps.

use crate::error::{Error, ErrorKind, exponential, number};

/// The share of the points that is kept: those whose [rank](crate::PointSet::rank) is below it. By
/// default all are.
///
/// Shares nest: a smaller one keeps a part of what a larger one keeps.
///
/// ```
/// use strew_core::{Keep, Placement, PointSet, Seed, Spacing, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let placement = Placement::new(Spacing::ONE, Seed(7)).with_keep(Keep::new(0.25)?);
/// let quarter = PointSet::new(table).placed(placement);
/// for point in quarter.chunk(20.0, [0, 0])? {
///     assert!(quarter.rank(point.id()) < 0.25);
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Keep(f64);

impl Keep {
    /// All points.
    pub const ALL: Self = Self(1.0);
    /// The least share. Rows are visited whether or not they keep points, so a smaller share would cost
    /// more than a wider spacing.
    pub const MIN: f64 = 1e-6;

    /// A share of the points, from [`MIN`](Self::MIN) to 1.
    ///
    /// # Errors
    /// [`ErrorKind::Keep`] outside [`MIN`](Self::MIN) to 1 and for NaN.
    pub fn new(share: f64) -> Result<Self, Error> {
        if (Self::MIN..=1.0).contains(&share) {
            Ok(Self(share))
        } else {
            let allowed = alloc::format!("a number from {} to 1", exponential(Self::MIN));
            Err(Error::new(ErrorKind::Keep, "keep", number(share), allowed))
        }
    }

    /// Any share from 0 to 1.
    pub(super) const fn unchecked(share: f64) -> Self {
        Self(share)
    }

    /// The share, from [`MIN`](Self::MIN) to 1.
    #[must_use]
    pub const fn get(self) -> f64 {
        self.0
    }
}

impl Default for Keep {
    fn default() -> Self {
        Self::ALL
    }
}
