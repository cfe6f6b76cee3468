//! Energies of periodic point sets.

use crate::measure::Sample;

/// An energy of a periodic point set.
pub trait SetEnergy: Sync {
    /// Returns the energy per point. Writes into `gradient`, for each point, the derivative of the
    /// *total* energy by the position of the point in mean spacings.
    ///
    /// Must return the same bits with any number of threads.
    fn evaluate(&self, set: &Sample, gradient: &mut [[f64; 2]]) -> f64;
}
