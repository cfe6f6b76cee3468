//! Radial power curves: what a spectrum should be.

mod correlation;
mod parameters;
mod pieces;
mod target;
mod text;

pub use correlation::LeastCorrelation;
pub(crate) use correlation::total_correlation;
pub(crate) use parameters::{from_parameters, to_parameters};
pub use target::{MAX_NU, MAX_POINTS, MAX_POWER, Target};
