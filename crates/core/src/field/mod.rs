//! Fields: shares that vary from place to place.
//!
//! A [`Field`] has a share in [0, 1] at each place of the plane, and [`PointSet::in_field`] has the set whose
//! density follows it. Closures are fields. A [`FieldSpec`] is one that a program can keep, compare and name
//! by a digest: shapes, pixels and noise, and what is joined from them.
//!
//! A point of a set belongs to the set in a field if its rank is below the share at its place; that place is looked at
//! once, and nothing else of the field matters to the point. Points do not move when others leave.
//!
//! [`PointSet::in_field`]: crate::PointSet::in_field

// `definition` has the trait. `spec` has the descriptions, `evaluate` their shares; they are made of `raster` (`pixels` laid
// over the plane by `grid`), `marks`, `noise` and the lines of `scale`. `rows` finds the points of a field in some rows, many at a time,
// where `tiles` leaves any. `Lattice::place` is the definition, point by point; walks leave out what bounds of the field
// rule out and find the same points with the same bits.

mod definition;
mod evaluate;
mod grid;
mod marks;
mod noise;
mod pixels;
mod raster;
mod rows;
mod scale;
mod spec;
mod tiles;

pub use definition::Field;
pub use grid::{Edges, Filter};
pub use marks::Marks;
pub use noise::Noise;
pub use pixels::Pixels;
pub use raster::{Raster, Terrain};
pub(super) use rows::{FieldRows, Source};
pub use spec::FieldSpec;
pub(super) use tiles::{candidates, constant, constant_until, empty_until};
