//! The number of steps by which points settle.

use super::Keep;
use crate::error::{Error, ErrorKind};

/// The number of steps by which points settle, 0 to 4. With 0 points stay where they are at full density. More steps
/// are smoother, and each costs its time again.
///
/// Thinned sets and those in fields settle by 2 steps by default. Sets with all points stay by default; with a number
/// from 1 on they make one small step, which moves the nearest points apart.
///
/// ```
/// use strew_core::{Keep, Placement, Seed, Settle, Spacing};
///
/// assert_eq!(Settle::new(3)?.steps(), 3);
/// assert_eq!(Settle::default().steps(), 2);
/// assert!(Settle::new(5).is_err());
/// // What that is for a share of the points.
/// let half = Keep::new(0.5)?;
/// assert_eq!([half, Keep::ALL].map(|keep| Settle::default().steps_at(keep)), [2, 0]);
/// assert_eq!([half, Keep::ALL].map(|keep| Settle::new(3).map_or(0, |s| s.steps_at(keep))), [3, 1]);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Settle {
    /// Of thinned sets, and in fields.
    steps: u8,
    /// Of sets with all points: 0 or 1.
    near: u8,
}

impl Settle {
    /// Points stay.
    pub const OFF: Self = Self { steps: 0, near: 0 };
    /// The default: most of the gain at half of the price of three.
    pub(crate) const TWO: Self = Self { steps: 2, near: 0 };
    /// The one step of sets with all points.
    const NEAR: Self = Self { steps: 0, near: 1 };
    /// The least share at which points settle. Sparser sets are thinned out of a wider spacing.
    pub const LEAST_SHARE: f64 = 1.0 / 1600.0;
    /// The largest number of steps.
    pub const MAX_STEPS: u32 = 4;

    /// A number of steps.
    ///
    /// # Errors
    /// [`ErrorKind::Settle`] above [`MAX_STEPS`](Self::MAX_STEPS).
    pub fn new(steps: u32) -> Result<Self, Error> {
        if steps <= Self::MAX_STEPS {
            Ok(Self {
                steps: steps as u8,
                near: steps.min(1) as u8,
            })
        } else {
            let allowed = alloc::format!("an integer from 0 to {}", Self::MAX_STEPS);
            Err(Error::new(ErrorKind::Settle, "settle", steps, allowed))
        }
    }

    /// The number of steps of thinned sets and in fields.
    #[must_use]
    pub const fn steps(self) -> u32 {
        self.steps as u32
    }

    /// The number of steps of a set that keeps a share of the points, without a field: with all points at most one.
    #[must_use]
    pub fn steps_at(self, keep: Keep) -> u32 {
        let settle = self.of_share(keep.get());
        settle.map_or(0, |settle| settle.steps().max(settle.near.into()))
    }

    /// How the points of a set settle that keeps a share of them, without a field, if they do.
    pub(crate) fn of_share(self, share: f64) -> Option<Self> {
        if share >= 1.0 {
            (self.near > 0).then_some(Self::NEAR)
        } else {
            (share >= Self::LEAST_SHARE && !self.is_off()).then_some(self)
        }
    }

    /// Whether it is the one step of sets with all points.
    pub(crate) const fn is_near(self) -> bool {
        self.steps == 0 && self.near > 0
    }

    /// Whether the points of thinned sets and of fields stay.
    #[must_use]
    pub(crate) const fn is_off(self) -> bool {
        self.steps == 0
    }
}

impl Default for Settle {
    /// Two steps, none with all points.
    fn default() -> Self {
        Self::TWO
    }
}
