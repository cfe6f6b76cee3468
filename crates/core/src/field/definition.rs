//! The trait of fields, and their canonical encoding, of which digests are made.

use crate::{shape::Region, table::Digest};

/// A share of the points at each place of the plane, or with `D` = 3 of space: 1 keeps all, 0 none.
///
/// Closures are fields. A field that knows its bounds over a box lets whole boxes be left out.
///
/// ```
/// use strew_core::{Field, PointSet, Region, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// // Denser toward the right.
/// let ramp = |[x, _]: [f64; 2]| x / 40.0;
/// assert_eq!(ramp.share([10.0, 3.0]), 0.25);
/// let set = PointSet::new(table).seed(7).in_field(ramp);
/// let count = |x| set.count(Region::new([x, 0.0], [x + 20.0, 40.0])?);
/// assert!(count(20.0)? > 2 * count(0.0)?);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub trait Field<const D: usize = 2>: Send + Sync {
    /// The share at a place, in world units. Below 0 and NaN count as 0, above 1 as 1. It must be the same
    /// each time.
    fn share(&self, at: [f64; D]) -> f64;

    /// Writes the shares at some places into `shares`, which has their number: the same bits as
    /// [`share`](Self::share), for fields that are faster at many places than at one.
    fn shares(&self, places: &[[f64; D]], shares: &mut [f64]) {
        for (share, at) in shares.iter_mut().zip(places) {
            *share = self.share(*at);
        }
    }

    /// Bounds of the share over a box, its edges included: no place in it has a share below the first or
    /// above the second. [0, 1] is always right.
    ///
    /// ```
    /// use strew_core::{Field, Region};
    ///
    /// struct Ramp;
    ///
    /// impl Field for Ramp {
    ///     fn share(&self, [x, _]: [f64; 2]) -> f64 {
    ///         x
    ///     }
    ///
    ///     fn bounds(&self, within: &Region) -> [f64; 2] {
    ///         [within.min()[0], within.max()[0]]
    ///     }
    /// }
    ///
    /// assert_eq!(Ramp.bounds(&Region::new([0.25, 0.0], [0.5, 9.0])?), [0.25, 0.5]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    fn bounds(&self, within: &Region<D>) -> [f64; 2] {
        let _ = within;
        [0.0, 1.0]
    }

    /// Bounds of how much the share changes along each axis for each world unit, within a box. Infinity is always
    /// right.
    fn slopes(&self, within: &Region<D>) -> [f64; D] {
        let _ = within;
        [f64::INFINITY; D]
    }
}

impl<const D: usize, F: Fn([f64; D]) -> f64 + Send + Sync> Field<D> for F {
    fn share(&self, at: [f64; D]) -> f64 {
        self(at)
    }
}

/// Collects the parts of a field: numbers of eight bytes each, the lowest first.
pub(super) struct Canon(blake3::Hasher);

impl Canon {
    /// A field of a kind.
    pub(super) fn new(kind: &str) -> Self {
        let mut canon = Self(blake3::Hasher::new());
        canon.0.update(b"strew field 1\0");
        canon.0.update(kind.as_bytes());
        canon.0.update(&[0]);
        canon
    }

    pub(super) fn number(&mut self, number: u64) {
        self.0.update(&number.to_le_bytes());
    }

    /// Numbers, after their number.
    pub(super) fn numbers(&mut self, numbers: &[f64]) {
        self.number(numbers.len() as u64);
        for number in numbers {
            // −0 is 0.
            self.number((number + 0.0).to_bits());
        }
    }

    /// Places, after their number.
    pub(super) fn places<const D: usize>(&mut self, places: &[[f64; D]]) {
        self.number(places.len() as u64);
        for place in places {
            self.numbers(place);
        }
    }

    pub(super) fn digest(&mut self, digest: Digest) {
        self.0.update(digest.as_bytes());
    }

    pub(super) fn finish(self) -> Digest {
        Digest::from_bytes(*self.0.finalize().as_bytes())
    }
}
