//! Radial power curves: what a spectrum should be.
//!
//! A [`Target`] is read by `text`: from lines of two numbers, or through `pieces` from TOML, where
//! `law` turns a power law into points. The history of a table records its curve in the same form. [`LeastCorrelation`] shows whether a point set can have the curve at all.

mod correlation;
mod law;
mod pieces;
mod target;
mod text;

pub use correlation::LeastCorrelation;
pub(crate) use correlation::total_correlation;
pub use target::{MAX_NU, MAX_POINTS, MAX_POWER, Target};
pub(crate) use text::{from_parameters, to_parameters};
