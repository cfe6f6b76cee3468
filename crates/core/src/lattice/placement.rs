//! The parameters that lay a table's points into the world: their mean spacing, the share of them that is kept, and the
//! number of steps by which they settle.

use super::seed::Seed;
use crate::{
    error::{Error, ErrorKind, exponential, number},
    warp::Warp,
};

/// Spacing, seed, warp and share. With a table's digest, the first three make a point a pure function
/// of its lattice address; the share decides which points exist.
///
/// ```
/// use strew_core::{Keep, Placement, Seed, Settle, Spacing, Warp};
///
/// let placement = Placement::new(Spacing::new(2.0)?, Seed(7));
/// assert_eq!(placement.warp, Warp::ON);
/// assert_eq!(placement.with_warp(Warp::OFF).warp, Placement::default_warp(Seed(0)));
/// let far = placement.with_keep(Keep::new(0.5)?).with_lod(Keep::new(0.1)?).with_settle(Settle::OFF);
/// assert_eq!((far.keep.get(), far.lod.get(), far.settle.steps()), (0.5, 0.1, 0));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The mean spacing, in world units.
    pub spacing: Spacing,
    /// The seed.
    pub seed: Seed,
    /// The strength of the warp.
    pub warp: Warp,
    /// The share of the points that is kept.
    pub keep: Keep,
    /// How points settle.
    pub settle: Settle,
    /// The level of detail: the part of the points that is left out of nothing but the answer, so that none of the
    /// others move.
    pub lod: Keep,
}

impl Placement {
    /// The default for a seed: all points, without warp for seed 0 and with [`Warp::ON`] for every
    /// other.
    #[must_use]
    pub const fn new(spacing: Spacing, seed: Seed) -> Self {
        Self {
            spacing,
            seed,
            warp: Self::default_warp(seed),
            keep: Keep::ALL,
            settle: Settle::TWO,
            lod: Keep::ALL,
        }
    }

    /// The default warp of a seed: off for seed 0, [`Warp::ON`] for every other.
    #[must_use]
    pub const fn default_warp(seed: Seed) -> Warp {
        if seed.0 == 0 { Warp::OFF } else { Warp::ON }
    }

    /// This placement with another share.
    #[must_use]
    pub const fn with_keep(self, keep: Keep) -> Self {
        Self { keep, ..self }
    }

    /// This placement with another number of steps by which points settle.
    #[must_use]
    pub const fn with_settle(self, settle: Settle) -> Self {
        Self { settle, ..self }
    }

    /// This placement with another level of detail.
    #[must_use]
    pub const fn with_lod(self, lod: Keep) -> Self {
        Self { lod, ..self }
    }

    /// The share of points that are kept and in the level of detail.
    pub(crate) const fn shown(&self) -> f64 {
        self.keep.get() * self.lod.get()
    }

    /// The share that multiplies those of a field. Where points settle, the level of detail is a choice among settled ones.
    pub(crate) const fn graded(&self) -> f64 {
        if self.settle.is_off() {
            self.shown()
        } else {
            self.keep.get()
        }
    }

    /// This placement with another warp.
    #[must_use]
    pub const fn with_warp(self, warp: Warp) -> Self {
        Self { warp, ..self }
    }
}

/// The mean spacing of points in world units: density^−½.
///
/// ```
/// use strew_core::Spacing;
///
/// assert_eq!(Spacing::from_density(4.0)?, Spacing::new(0.5)?);
/// assert!(Spacing::new(f64::NAN).is_err());
/// assert!(Spacing::from_density(Spacing::MAX_DENSITY).is_ok());
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
