//! Measuring point sets: spectrum, distances and cells, of whole periods and of windows.
//!
//! Everything is at unit density: lengths are in mean spacings, frequencies ν in cycles per mean
//! spacing, and white noise has power 1. Nothing here reaches a table but through figures rounded
//! to four digits, so the platform's own functions may be used.

mod cell_list;
mod crispness;
mod distance;
mod from_table;
mod nufft;
mod rdf;
mod set;
mod spectrum;
mod taper;
mod voronoi;

pub(crate) use cell_list::CellList;
pub use crispness::Crispness;
pub use distance::Distances;
pub use from_table::{twin_set, window_set};
pub use rdf::Rdf;
pub use set::{Torus, Window};
pub use spectrum::{Ring, Spectrum, Summary};
pub use voronoi::Voronoi;
