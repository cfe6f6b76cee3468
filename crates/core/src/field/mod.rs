//! Fields: shares that vary from place to place.
//!
//! A [`Field`] has a share in [0, 1] at each place of the plane, and [`PointSet::in_field`] has the set whose
//! density follows it. Closures are fields. A [`FieldSpec`] is one that a program can keep, compare and name
//! by a digest: shapes, pixels and noise, and what is joined from them.
//!
//! ```
//! use strew_core::{PointSet, Region, Table, field::{FieldSpec, Marks}};
//!
//! # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
//! let river = Marks::Lines(vec![vec![[0.0, 8.0], [30.0, 21.0], [64.0, 30.0]]]);
//! let reeds = FieldSpec::distance(river, [1.0, 9.0], [1.0, 0.0])?;
//! let set = PointSet::new(table).seed(7).in_field(reeds);
//! let number = set.count(Region::chunk(64.0, [0, 0])?)?;
//! assert!(number > 300 && number < 2000);
//! # Ok::<(), strew_core::Error>(())
//! ```
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
