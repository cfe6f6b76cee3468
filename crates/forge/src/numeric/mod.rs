//! The numbers that decide a table: functions and random numbers with the same bits on every machine.

mod bessel;
mod exp;
mod random;

pub use bessel::BesselJ0;
pub use exp::exp;
pub use random::SplitMix;
