//! Objectives: what a descent lowers.

/// An energy as a function of a table's vectors, which are in mean spacings and called *moves*.
pub trait Objective {
    /// The share of the points that each block has. The shares sum to 1.
    fn masses(&self) -> &[f64];

    /// Returns the energy per point. Writes into `gradient`, for each block, the derivative by the
    /// position of one instance, averaged over its instances; the product with the mass of the
    /// block is the derivative by its vector.
    ///
    /// Must return the same bits with any number of threads.
    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64;

    /// The moves that the neighbor lists were built for; empty if there are no lists. The order of
    /// sums follows the lists, so the bits of the next evaluation depend on them.
    fn prepared_for(&self) -> &[[f64; 2]] {
        &[]
    }

    /// Builds the neighbor lists for these moves, to resume a descent with the same lists.
    fn prepare_for(&mut self, moves: &[[f64; 2]]) {
        let _ = moves;
    }

    /// The number of pairs that an evaluation visits, known after the first; 0 if it visits none.
    fn pairs(&self) -> usize {
        0
    }
}
