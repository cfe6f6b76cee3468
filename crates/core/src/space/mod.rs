//! Points in space: three dimensions.
//!
//! The construction of the plane extends to space. The pattern is a union of eight Cartesian products of the same
//! one-dimensional sets, a small table has a vector for each of n³ blocks, and a seed chooses an origin, one of the 48
//! symmetries of the cube and a warp. [`SpaceSet`] has the words of [`PointSet`](crate::PointSet).
//!
//! `pattern` has the pattern, `table` the vectors, `warp` the shears, `lattice` which addresses have
//! points and where; `scope` what of a lattice is requested.
//! `walk` makes points row by row or batch by batch from `columns` of planes, `cells` and `template`s, `settled` those that
//! settle; `mask` narrows a set, and `clearance` leaves out those too near other sets; `closed` and `count`
//! count them. `plan` is a request made ready, whose points are written in a `format`; `attributes` are their further
//! values. `nearest` finds neighbors. `set` is all of this, `shipped` the table that the crate has.

mod attributes;
mod cells;
mod clearance;
mod closed;
mod columns;
mod count;
mod format;
mod lattice;
mod mask;
mod nearest;
mod pattern;
mod plan;
mod point;
mod scope;
mod set;
mod settled;
#[cfg(feature = "tables")]
mod shipped;
mod table;
mod template;
mod walk;
mod warp;

pub use attributes::BoundAttributes;
pub use format::Format;
pub use lattice::LATTICE_LIMIT;
pub use pattern::Pattern;
pub use plan::{Blocks, Plan};
pub use point::{Point, PointId};
pub use set::SpaceSet;
#[cfg(feature = "tables")]
pub use shipped::BLUE;
pub use table::Table;
pub(crate) use warp::stretch;

pub use crate::{
    LeastDistance,
    shape::{Prism, Volume},
};

/// Points with their addresses, relative to an origin.
type Batch = crate::batch::Batch<3, [i32; 3]>;
/// A point of a set, which knows its attributes.
pub type Member = crate::Member<PointId>;
/// The points of a plan, one by one, in order.
pub type Members = crate::Members<PointId>;
/// A point of a set near a place, and its distance.
pub type Neighbor = crate::Neighbor<PointId>;
/// A place in the order of a request's points.
pub type Cursor = crate::Cursor<PointId>;
/// A half-open box in world coordinates.
pub type Region = crate::Region<3>;
/// A ball without its surface.
pub type Ball = crate::shape::Ball<3>;
