//! Energies: what an optimizer lowers.
//!
//! There are two kinds. A [`PairEnergy`] is a sum over pairs of points of a function of their
//! distance; since the frequency of every pair of blocks is known exactly, it needs no point set
//! at all (see [`crate::optimize::Pairs`]). A [`SetEnergy`] is anything else that can be computed
//! on a periodic point set, such as an error of its spectrum. Every pair energy is a set energy.

mod gaussian;
mod guard;
mod lloyd;
mod pairwise;

pub use gaussian::Gaussian;
pub use guard::Guard;
pub use lloyd::{Cell, Lloyd};
pub use pairwise::Pairwise;

use crate::measure::Torus;

/// An energy that is a sum over unordered pairs of points, at unit density.
pub trait PairEnergy: Sync {
    /// The distance, in mean spacings, from which on the energy is exactly zero.
    fn cutoff(&self) -> f64;

    /// For the square of a distance: the energy of the pair, and twice its derivative by the
    /// square, so that this factor times (p − q) is the gradient at p. Both 0 from the cut-off on.
    /// Plain arithmetic only (see [`numeric`](crate::numeric)): its bits reach the table.
    fn pair(&self, distance_squared: f64) -> (f64, f64);
}

/// An energy of a periodic point set.
pub trait SetEnergy: Sync {
    /// The energy per point. Writes into `gradient`, one entry a point, the derivative of the
    /// *whole* energy by that point's position, in mean spacings.
    ///
    /// Must give the same bits whatever the number of threads.
    fn evaluate(&self, set: &Torus, gradient: &mut [[f64; 2]]) -> f64;
}
