//! Energies that are sums over pairs of points, and sums of such energies.

/// An energy that is a sum over unordered pairs of points, at unit density.
pub trait PairEnergy: Sync {
    /// The cut-off: the distance in mean spacings from which on the energy is exactly 0.
    fn cutoff(&self) -> f64;

    /// Returns the energy of a pair, given its squared distance, and twice the derivative of the
    /// energy by the squared distance. The gradient at p is the second value times p − q. Both are
    /// 0 from the cut-off on.
    ///
    /// The bits decide a table, so the arithmetic must be that of [`numeric`](crate::numeric).
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
