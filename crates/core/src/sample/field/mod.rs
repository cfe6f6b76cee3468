//! Fields: shares that vary from place to place.
//!
//! A [`Field`] has a share in [0, 1] at each place. A point of a set belongs to the set in a field if its
//! rank is below the share at the place where it is at full density; that place is looked at once, and
//! nothing else of the field matters to the point. Where the table has a [ladder](crate::table::Ladder), the
//! point then moves to its place at that share.
//!
//! `definition` has the trait, `raster` fields of pixels, `graded` the set in a field, and `walk` its points in
//! a box. [`Graded::point`] is the definition; the walk leaves out what bounds of the field rule out and
//! finds the same points with the same bits.

mod definition;
mod graded;
mod raster;
mod walk;

pub use definition::Field;
pub use graded::Graded;
pub use raster::Raster;
