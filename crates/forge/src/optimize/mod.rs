//! Optimizing in table space: the unknowns are the n² vectors of a table, not points.
//!
//! An [`Objective`] is an energy as a function of the vectors, which are called *moves* here. Three
//! objectives exist. [`Pairs`] (a pair energy) and [`Radial`] (the error of a radial power curve)
//! are sums over pairs of blocks and need no points: `ground` knows which blocks meet and how often, by the overlaps of
//! intervals, and `pairs` lists those that are near each other. [`Sets`] evaluates any other energy on twins. For
//! [`Radial`], `rings` turns a histogram of distances into radial power. A [`Descent`] lowers an
//! objective from the random start of [`jitter`].

mod descent;
mod ground;
mod pairs;
mod radial;
mod rings;
mod sets;

#[cfg(test)]
pub(crate) use descent::check_slopes;
pub use descent::{Descent, Objective, jitter};
pub(crate) use ground::{Ground, Pair, moves_of, overlaps};
pub use pairs::Pairs;
pub(crate) use pairs::{CHUNK, fill, longest, sum};
pub use radial::Radial;
pub use rings::RadialWeights;
pub use sets::Sets;
