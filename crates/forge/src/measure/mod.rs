//! Measuring point sets: spectrum, distances and Voronoi cells of whole periods and of windows.
//!
//! A set is a [`Sample`], of the plane or in space: one period of a periodic set, or a window of an unbounded one;
//! [`twin_set`] and [`window_set`] make them from a table, [`square_set`] from a served set. [`Spectrum`] is computed by
//! `fourier`; its [`Ring`]s yield the [`Summary`] and the [`Crispness`].
//! [`Distances`], [`Rdf`] and [`Voronoi`] look up neighbors in a cell list. [`recurrence`] is how
//! much of a set is found again elsewhere in it, [`Shared`] what two sets have in common.
//!
//! Everything is at unit density: lengths are in mean spacings, frequencies ν in cycles per mean
//! spacing, and white noise has power 1. Of these results only figures rounded to four digits reach
//! a table, so the platform's own math functions may be used.

mod distance;
mod fourier;
mod pair;
mod recurrence;
mod set;
mod spectrum;
mod voronoi;

pub use crate::twins::{ThinnedTwin, twin_set};
pub(crate) use distance::HEXAGONAL;
pub use distance::{Distances, Rdf};
pub(crate) use fourier::{of_grid, sums};
pub use pair::Shared;
pub use recurrence::recurrence;
pub use set::{Sample, square_set, window_set};
pub(crate) use set::{root, wrap};
pub use spectrum::{BANDS, Crispness, Ring, Spectrum, Summary};
pub(crate) use spectrum::{ring_sums, rings_of};
pub use voronoi::Voronoi;
pub(crate) use voronoi::{Polygon, cells};
