//! Figures of points in space: power, distances, what is left of a lattice in small windows, and what two sets share.
//!
//! Units are those of unit density: frequencies ν in N^⅓, power 1 for white noise, distances over the densest packing's
//! (√2/N)^⅓. Everything here has the same bits on every machine and with any number of threads.

mod distance;
mod fourier;
mod points;
mod power;
mod shared;
mod transform;

pub use distance::SpaceDistances;
pub use points::{SpacePoints, is_uniform_in_space};
pub use power::{LocalPower, Shell, SpacePower};
pub use shared::SpaceShared;
