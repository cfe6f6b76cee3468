//! Energies: what an optimizer lowers.
//!
//! There are two kinds. A [`PairEnergy`] is a sum over pairs of points of a function of their
//! distance; since the frequency of every pair of blocks is known exactly, it needs no point set
//! at all (see [`crate::optimize::Pairs`]). A [`SetEnergy`] is anything else that can be computed
//! on a periodic point set, such as an error of its spectrum. Every pair energy is a set energy.

mod gaussian;
mod guard;
mod lloyd;
mod pair;
mod pairwise;
mod set;

pub use gaussian::Gaussian;
pub use guard::Guard;
pub use lloyd::{Cell, Lloyd};
pub use pair::PairEnergy;
pub use pairwise::Pairwise;
pub use set::SetEnergy;
