//! Points in space and their ids.

use core::{fmt, str::FromStr};

use crate::{error::Error, lattice::lattice_of};

/// The stable id of a point: its lattice address. The text form is `x:y:z`, three decimal integers.
///
/// ```
/// use strew_core::space::PointId;
///
/// let id: PointId = "-31:52:7".parse()?;
/// assert_eq!(id, PointId { x: -31, y: 52, z: 7 });
/// assert_eq!(id.to_string(), "-31:52:7");
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(C)]
pub struct PointId {
    /// The lattice coordinate along x.
    pub x: i64,
    /// The lattice coordinate along y.
    pub y: i64,
    /// The lattice coordinate along z.
    pub z: i64,
}

/// A point with its id, in world coordinates.
///
/// ```
/// use strew_core::space::{Point, SpaceSet, Table};
///
/// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
/// let Point { id, x, .. } = set.chunk(8.0, [0, 0, 0])?.to_vec()[0];
/// assert!((0.0..8.0).contains(&x));
/// assert_eq!(set.point(id).map(|point| point.point().x), Some(x));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Point {
    /// The stable id.
    pub id: PointId,
    /// The world coordinate along x.
    pub x: f64,
    /// The world coordinate along y.
    pub y: f64,
    /// The world coordinate along z.
    pub z: f64,
}

impl Point {
    /// The world coordinates.
    #[must_use]
    pub const fn at(&self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }
}

impl PointId {
    /// The id of a lattice address.
    #[inline]
    pub(super) const fn of([x, y, z]: [i64; 3]) -> Self {
        Self { x, y, z }
    }

    /// The lattice address.
    #[inline]
    pub(super) const fn lattice(self) -> [i64; 3] {
        [self.x, self.y, self.z]
    }
}

impl fmt::Display for PointId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.x, self.y, self.z)
    }
}

impl FromStr for PointId {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        const ALLOWED: &str = "three integers joined by colons, such as -31:52:7";
        lattice_of(text, ALLOWED).map(Self::of)
    }
}
