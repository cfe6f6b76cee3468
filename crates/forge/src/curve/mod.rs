//! Radial power curves: what a spectrum should be.
//!
//! A [`Target`] is read by `text`, from lines of two numbers or through `pieces` from TOML. `parameters`
//! records it in the history of a table and reads it back. [`LeastCorrelation`] tells before any work
//! whether a point set can have the curve.

mod correlation;
mod parameters;
mod pieces;
mod target;
mod text;

pub use correlation::LeastCorrelation;
pub(crate) use correlation::total_correlation;
pub(crate) use parameters::{from_parameters, to_parameters};
pub use target::{MAX_NU, MAX_POINTS, MAX_POWER, Target};
