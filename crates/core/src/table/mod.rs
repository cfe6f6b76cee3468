//! Displacement tables: one vector per block of a neighborhood map.
//!
//! A table and the pattern of its α make a point set: position = scale · ((x, y) +
//! D\[block(dY)\]\[block(dX)\]). Vectors are fixed point, so a table means the same on every machine.
//!
//! `displacement` has the [`Table`], made of the `parts` that a `file` holds; `units` the fixed point,
//! `provenance` the history, `digest` the name, `text` the published text form. `shipped` has the
//! tables built into this crate.

mod digest;
mod displacement;
mod file;
mod parts;
mod provenance;
#[cfg(feature = "tables")]
pub(crate) mod shipped;
mod text;
mod units;

pub use digest::Digest;
pub use displacement::Table;
pub use file::{FORMAT_VERSION, MAX_FILE_BYTES};
pub use provenance::{Figures, Provenance};
#[cfg(feature = "tables")]
pub use shipped::BLUE;
pub(crate) use units::fixed;
pub use units::{Displacement, FRACTION_BITS, MAX_DISPLACEMENT, from_grid_units, to_grid_units};
