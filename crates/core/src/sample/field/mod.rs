//! Fields: shares that vary from place to place.
//!
//! A [`Field`] has a share in [0, 1] at each place. A point of a set belongs to the set in a field if its
//! rank is below the share at its place; that place is looked at once, and nothing else of the field matters to
//! the point. Points do not move when others leave.
//!
//! `definition` has the trait. `spec` has the descriptions that a program can keep, compare and name by a digest,
//! `evaluate` their shares; they are made of `raster` and `terrain` (both `pixels` laid over the plane by `grid`;
//! `missing` has those without a number), `marks`, `noise` and the lines of `scale`. `rows` finds the points of a field in some rows, many at a time, where
//! `tiles` leaves any. `Lattice::place` is the definition, point by point; walks leave out
//! what bounds of the field rule out and find the same points with the same bits.

mod canon;
mod cost;
mod definition;
mod evaluate;
mod grid;
mod marks;
mod missing;
mod noise;
mod pixels;
mod raster;
mod rows;
mod scale;
mod spec;
mod terrain;
mod tiles;

pub use definition::Field;
pub use grid::{Edges, Filter};
pub use marks::Marks;
pub use noise::Noise;
pub use pixels::Pixels;
pub use raster::Raster;
pub(super) use rows::{FieldRows, Source};
pub use spec::FieldSpec;
pub use terrain::Terrain;
pub(super) use tiles::{candidates, constant, constant_until, empty_until};
