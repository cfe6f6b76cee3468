//! What a descent lowers.

/// An energy as a function of a table's vectors, in mean spacings (*moves*).
pub trait Objective {
    /// The share of points that each block has; they sum to 1.
    fn masses(&self) -> &[f64];

    /// The energy per point. Writes into `gradient` the derivative by the position of one instance
    /// of each block, the mean over its instances; times its mass it is the derivative by the
    /// block's vector.
    ///
    /// Gives the same bits whatever the number of threads.
    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64;

    /// The moves that lists of neighbors were made for. The order of a sum follows those lists, so
    /// they are part of what decides the next bits; empty if there are none.
    fn prepared_for(&self) -> &[[f64; 2]] {
        &[]
    }

    /// Makes the lists for these moves, as if they had been evaluated when the lists were made.
    fn prepare_for(&mut self, moves: &[[f64; 2]]) {
        let _ = moves;
    }

    /// How many pairs one evaluation visits (after the first), if it visits pairs.
    fn pairs(&self) -> usize {
        0
    }
}
