//! Worlds: queries that are described once, so that an address only names them.
//!
//! A world is a document with the members of a query but its region: layers or one set of points, a common seed, a
//! limit, the form of answers. [`Worlds`] holds those of the configuration and of a folder, checked against the tables
//! and fields that are loaded. A query that names a world takes from it the members that it lacks.

mod document;
mod loaded;
#[cfg(test)]
mod tests;

pub use document::{World, Worlds};
pub use loaded::{by_layer, with_path};
