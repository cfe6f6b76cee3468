//! Energies of point sets.

use crate::measure::Torus;

/// An energy of a periodic point set.
pub trait SetEnergy: Sync {
    /// The energy per point. Writes into `gradient`, one entry a point, the derivative of the
    /// *whole* energy by that point's position, in mean spacings.
    ///
    /// Must give the same bits whatever the number of threads.
    fn evaluate(&self, set: &Torus, gradient: &mut [[f64; 2]]) -> f64;
}
