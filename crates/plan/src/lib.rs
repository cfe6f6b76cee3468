//! Plans: a checked query with its tables becomes points whose exact number is known before any is made.
//!
//! [`effort`] prices a query from quick estimates. [`Planned`] is a query with its plans and becomes an answer in any
//! format; [`Placed`] is a set without a region, for single points and nearest ones. [`store`] finds the table of a set
//! and those that its kinds need, for daemons, libraries and command lines alike. A [`Library`] does all of it in the
//! calling thread: the bindings use it. Depends on the query, the catalog and the encoders; knows no async runtime, no
//! cache and no protocol.

#![allow(missing_docs, reason = "internal: names say what items are")]

mod attributes;
pub mod effort;
mod head;
mod lane;
pub mod library;
mod planned;
mod planned_set;
mod planner;
mod resolve;
mod single;
pub mod store;
mod terrain;
mod volume;

pub use effort::{Neighbors, considered};
pub use head::{QueryEcho, TableEcho};
pub use lane::Lane;
pub use library::{Columns, Library};
pub use planned::{Placed, PlacedPoints, Planned};
pub use planned_set::PlannedSet;
pub use single::Found;
pub use terrain::{ANGLE, Ground, OnTerrain};
