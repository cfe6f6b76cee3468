//! Displacement tables: one vector per block of a neighborhood map.
//!
//! A table and the pattern of its α make a point set: position = scale · ((x, y) +
//! D\[block(dY)\]\[block(dX)\]). Vectors are fixed point, so a table means the same on every machine.
//!
//! ```
//! use strew_core::{Map, PointId, PointSet, Table, table::{Provenance, from_grid_units}};
//!
//! let map = Map::new("sqrt(3)".parse()?, 20)?;
//! let blocks = map.intervals() * map.intervals();
//! let vector = [0.5, -0.25].map(|v| from_grid_units(v).expect("short"));
//! let table = Table::new(map, "moved", vec![vector; blocks], Provenance::default())?;
//! let scale = table.alpha().set_side_f64();
//! let point = PointSet::new(table).point(PointId { x: 0, y: 0 }).expect("in the pattern");
//! assert_eq!(point.at(), [0.5 * scale, -0.25 * scale]);
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! `tables` has the tables of the plane and of space, made of the `parts` that a `file` holds; `displacement` has the
//! [`Table`] of the plane, and `derived` makes one from another; `provenance` has the history, `digest` the
//! name, `text` the published text form. `ranks` is the order in which blocks leave when a set is thinned. `mix` has the
//! kinds of points, in the ratio of `shares`. `symmetry` has the ways to turn all of these, `shipped` the tables and labels built into this crate.

mod derived;
mod digest;
mod displacement;
mod file;
mod mix;
mod parts;
mod provenance;
mod ranks;
mod shares;
#[cfg(feature = "tables")]
pub(crate) mod shipped;
mod symmetry;
mod tables;
mod text;

pub use digest::Digest;
pub use displacement::Table;
pub use file::{FORMAT_VERSION, Head, MAX_FILE_BYTES};
pub(crate) use mix::Labels;
pub use mix::{Mix, Split};
pub use parts::{Displacement, FRACTION_BITS, MAX_DISPLACEMENT, from_grid_units, to_grid_units};
pub(crate) use parts::{Parts, Vector, fixed};
pub use provenance::{Figures, Provenance};
pub use ranks::Ranks;
pub(crate) use ranks::{Cut, Order};
pub use shares::Shares;
#[cfg(feature = "tables")]
pub use shipped::{BLUE, joint_files};
pub(crate) use symmetry::{Symmetry, TurnedTable};
pub use tables::TableOf;
