//! Points near a place.
//!
//! `scan` visits the points around a place. `search` returns the nearest ones and those within a radius,
//! and `limits` refuses what would take too long; it also counts and stops visits. `mask` decides by such neighbors
//! which points of a set exist: those in its area that keep clear of other sets. `clear` keeps the points of these around
//! many places, `tile` by tile, in the plane and in space.

pub(crate) mod clear;
pub(crate) mod limits;
mod mask;
pub(super) mod scan;
pub(super) mod search;
mod tile;

pub use limits::Visits;
pub use mask::Clearance;
pub(super) use mask::{Guard, Mask, Other};
pub use search::Neighbor;
