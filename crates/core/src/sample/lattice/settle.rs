//! The number of steps by which points settle.

use crate::error::{Error, ErrorKind};

/// The number of steps by which the points of thinned sets and of fields settle, 0 to 4. With 0 points stay where they
/// are at full density. More steps are smoother, and each costs its time again.
///
/// ```
/// use strew_core::Settle;
///
/// assert_eq!(Settle::new(3)?.steps(), 3);
/// assert_eq!(Settle::default().steps(), 2);
/// assert!(Settle::new(5).is_err());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Settle {
    steps: u8,
}

impl Settle {
    /// Points stay.
    pub const OFF: Self = Self { steps: 0 };
    /// The default: most of the gain at half of the price of three.
    pub(crate) const TWO: Self = Self { steps: 2 };
    /// The least share at which points settle. Sparser sets are thinned out of a wider spacing.
    pub const LEAST_SHARE: f64 = 1.0 / 1600.0;
    /// The largest number of steps.
    pub const MAX_STEPS: u32 = 4;

    /// A number of steps.
    ///
    /// # Errors
    /// [`ErrorKind::Settle`] above [`MAX_STEPS`](Self::MAX_STEPS).
    ///
    /// ```
    /// use strew_core::{ErrorKind, Settle};
    ///
    /// assert_eq!(Settle::new(0)?, Settle::OFF);
    /// assert_eq!(Settle::new(9).unwrap_err().kind(), ErrorKind::Settle);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn new(steps: u32) -> Result<Self, Error> {
        if steps <= Self::MAX_STEPS {
            Ok(Self { steps: steps as u8 })
        } else {
            let allowed = alloc::format!("an integer from 0 to {}", Self::MAX_STEPS);
            Err(Error::new(ErrorKind::Settle, "settle", steps, allowed))
        }
    }

    /// The number of steps.
    ///
    /// ```
    /// use strew_core::Settle;
    ///
    /// assert_eq!(Settle::OFF.steps(), 0);
    /// ```
    #[must_use]
    pub const fn steps(self) -> u32 {
        self.steps as u32
    }

    /// Whether points stay.
    #[must_use]
    pub(crate) const fn is_off(self) -> bool {
        self.steps == 0
    }
}

impl Default for Settle {
    /// Two steps.
    fn default() -> Self {
        Self::TWO
    }
}
