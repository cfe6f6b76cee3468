//! Radial power curves: what a spectrum should be.
//!
//! A [`Target`] is read by `text`: from lines of two numbers, or through `pieces` from TOML, which
//! turns power laws into points. The history of a table records its curve in lines of two numbers,
//! too. [`LeastCorrelation`] shows whether a point set can have the curve at all.

mod correlation;
mod pieces;
mod target;
mod text;

pub use correlation::LeastCorrelation;
pub(crate) use correlation::total_correlation;
pub use target::{MAX_NU, MAX_POINTS, MAX_POWER, Target};
pub(crate) use text::{from_parameters, to_parameters};
