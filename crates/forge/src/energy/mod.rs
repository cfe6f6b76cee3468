//! Energies: the functions that an optimizer lowers.
//!
//! There are two kinds. A [`PairEnergy`] is a sum over pairs of points of a function of their
//! distance: [`Gaussian`], [`Guard`], or the sum of two. It can be evaluated without points,
//! because the frequency of every pair of blocks is known exactly (see [`crate::optimize::Pairs`]).
//! A [`SetEnergy`] is any function of a periodic point set, such as [`Lloyd`].

mod lloyd;
mod pair;

pub use lloyd::{Cell, Lloyd};
pub use pair::{Gaussian, Guard, PairEnergy, SetEnergy};
