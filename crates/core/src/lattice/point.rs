//! Points, their ids and their ranks.
//!
//! The rank of a point is its place in the order in which points leave when a set is thinned.
//!
//! The table has the order of its blocks (see [`Ranks`](crate::table::Ranks)). Points do not move when others
//! leave, and the points that are left are whole blocks and a strip of one more. Mean power below ν = 0.5 and
//! δ_min of what is left, in units of the thinned set, on the twin 265/153:
//!
//! | λ | random | blue, 63 intervals | blue, 129 |
//! |---|---|---|---|
//! | 1/2 | 0.50 | 0.069, 0.50 | 0.065, 0.51 |
//! | 1/4 | 0.75 | 0.072, 0.45 | 0.065, 0.44 |
//! | 1/16 | 0.94 | 0.085, 0.51 | 0.066, 0.45 |
//! | 1/64 | 0.98 | 0.074, 0.50 | 0.068, 0.47 |

use core::{fmt, str::FromStr};

use crate::{
    error::{Error, ErrorKind, shown},
    pattern::Pattern,
    table::TurnedTable,
};

/// The stable id of a point: its lattice address. The text form is `x:y`, two decimal integers.
///
/// An id finds its point again in the same point set; other sets have other points under it, or none.
///
/// ```
/// use strew_core::PointId;
///
/// let id: PointId = "-31:52".parse()?;
/// assert_eq!(id, PointId { x: -31, y: 52 });
/// assert_eq!(id.to_string(), "-31:52");
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(C)]
pub struct PointId {
    /// The lattice column.
    pub x: i64,
    /// The lattice row.
    pub y: i64,
}

/// A point with its id, in world coordinates.
///
/// ```
/// use strew_core::{Point, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(8.0, [0, 0])?;
/// let Point { id, x, y } = plan.to_vec()[0];
/// assert!((0.0..8.0).contains(&x) && (0.0..8.0).contains(&y));
/// assert_eq!(plan.iter().next().map(|member| member.id()), Some(id));
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
}

impl Point {
    /// The world coordinates.
    #[must_use]
    pub const fn at(&self) -> [f64; 2] {
        [self.x, self.y]
    }
}

impl fmt::Display for PointId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.x, self.y)
    }
}

impl FromStr for PointId {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        const ALLOWED: &str = "two integers joined by a colon, such as -31:52";
        lattice_of(text, ALLOWED).map(|[x, y]| Self { x, y })
    }
}

/// The lattice address of an id's text: integers joined by colons.
pub(crate) fn lattice_of<const D: usize>(
    text: &str,
    allowed: &'static str,
) -> Result<[i64; D], Error> {
    let mut parts = text.split(':');
    let mut number = || parts.next().and_then(|part| part.parse().ok());
    let at = [0; D].map(|zero| number().unwrap_or(zero));
    // An id has one text: no plus sign, no leading zeros, no minus zero.
    if at.map(|v: i64| alloc::format!("{v}")).join(":") == text {
        return Ok(at);
    }
    Err(Error::new(ErrorKind::PointId, "id", shown(text), allowed))
}

/// The largest number below 1.
const GREATEST: f64 = 1.0 - f64::EPSILON / 2.0;

/// The rank of a point of a turned table's pattern, in [0, 1); the greatest for an address without a point.
pub(crate) fn rank(turned: &TurnedTable, pattern: &Pattern, id: PointId) -> f64 {
    let (index_x, index_y) = pattern.index(id.x, id.y);
    let map = turned.table().map();
    let (Some(x), Some(y)) = (map.interval_of(index_x), map.interval_of(index_y)) else {
        return GREATEST;
    };
    let (order, interval) = (turned.order(), map.interval(x));
    let position = order.position(y * map.intervals() + x);
    let (offset, length) = (index_x - interval.start, interval.end - interval.start);
    order.rank(position, offset, length)
}

/// The kind of a point of a turned table's pattern; `None` for an address without a point, and for a table without
/// kinds.
pub(crate) fn kind(turned: &TurnedTable, pattern: &Pattern, id: PointId) -> Option<u8> {
    let (index_x, index_y) = pattern.index(id.x, id.y);
    let map = turned.table().map();
    let block = [map.interval_of(index_x)?, map.interval_of(index_y)?];
    let labels = turned.labels()?;
    Some(labels.kind(map.intervals(), block, index_x))
}
