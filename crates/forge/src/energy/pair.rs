//! Energies that are sums over pairs of points.

/// An energy that is a sum over unordered pairs of points, at unit density.
pub trait PairEnergy: Sync {
    /// The distance, in mean spacings, from which on the energy is exactly zero.
    fn cutoff(&self) -> f64;

    /// For the square of a distance: the energy of the pair, and twice its derivative by the
    /// square, so that this factor times (p − q) is the gradient at p. Both 0 from the cut-off on.
    /// Plain arithmetic only (see [`numeric`](crate::numeric)): its bits reach the table.
    fn pair(&self, distance_squared: f64) -> (f64, f64);
}

/// The sum of two pair energies.
impl<A: PairEnergy, B: PairEnergy> PairEnergy for (A, B) {
    fn cutoff(&self) -> f64 {
        self.0.cutoff().max(self.1.cutoff())
    }

    #[inline]
    fn pair(&self, distance_squared: f64) -> (f64, f64) {
        let (a, b) = (self.0.pair(distance_squared), self.1.pair(distance_squared));
        (a.0 + b.0, a.1 + b.1)
    }
}
