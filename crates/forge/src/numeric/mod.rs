//! Functions and random numbers with the same bits on every machine, because they decide tables.
//!
//! They use +, −, ×, ÷ and √ on `f64` and `f32` in a fixed order. IEEE 754 defines these operations to the
//! last bit, and Rust neither contracts nor reorders them. Where speed does not matter, `libm`
//! serves as well: the pieces of a [curve](crate::curve) use its `pow`.

mod bessel;
mod exp;
mod random;
mod spreading;

pub use bessel::BesselJ0;
pub use exp::{exp, exp32};
pub use random::SplitMix;
pub(crate) use spreading::Kernel;
