//! Energies: the functions that an optimizer lowers.
//!
//! There are two kinds. A [`PairEnergy`] is a sum over pairs of points of a function of their
//! distance: [`Gaussian`], [`Guard`], or the sum of two. It can be evaluated without points,
//! because the frequency of every pair of blocks is known exactly (see [`crate::optimize::Pairs`]).
//! A [`SetEnergy`] is any function of a periodic point set, such as [`Lloyd`].

use crate::{measure::Sample, numeric::exp};

mod lloyd;

pub use lloyd::{Cell, Lloyd};

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

/// An energy of a periodic point set.
pub trait SetEnergy: Sync {
    /// Returns the energy per point. Writes into `gradient`, for each point, the derivative of the
    /// *total* energy by the position of the point in mean spacings.
    ///
    /// Must return the same bits with any number of threads.
    fn evaluate(&self, set: &Sample, gradient: &mut [[f64; 2]]) -> f64;
}

/// Gaussian blue noise: E = Σ exp(−d²/2σ²) over pairs (Ahmed, Ren, Wonka 2022).
///
/// In terms of the spectrum E is a sum of P(k)·exp(−2π²σ²ν²): the wider the Gaussian, the more low
/// frequencies dominate. σ = 1 leaves the least power at low frequencies, σ = 0.8 makes a sharper
/// set, and at σ ≤ 0.6 sets crystallize.
#[derive(Clone, Copy, Debug)]
pub struct Gaussian {
    /// −1/(2σ²).
    rate: f64,
    /// −1/σ².
    slope: f64,
    cutoff_squared: f64,
    cutoff: f64,
}

/// The cut-off in units of σ, where the Gaussian is 3·10⁻⁷.
const CUTOFF: f64 = 5.5;

impl Gaussian {
    /// The Gaussian of width `sigma` in mean spacings; 0.65 to 1.2 are useful.
    pub fn new(sigma: f64) -> Self {
        let cutoff = CUTOFF * sigma;
        Self {
            rate: -0.5 / (sigma * sigma),
            slope: -1.0 / (sigma * sigma),
            cutoff_squared: cutoff * cutoff,
            cutoff,
        }
    }
}

impl PairEnergy for Gaussian {
    fn cutoff(&self) -> f64 {
        self.cutoff
    }

    #[inline]
    fn pair(&self, distance_squared: f64) -> (f64, f64) {
        // Selections instead of branches, so that loops vectorize. The argument stays within the
        // range of `exp`.
        let inside = distance_squared < self.cutoff_squared;
        let clamped = if inside { distance_squared } else { 0.0 };
        let value = exp(self.rate * clamped);
        let value = if inside { value } else { 0.0 };
        (value, self.slope * value)
    }
}

/// A guard against close pairs: E = Σ s·(1 − d²/r²)³ over pairs closer than r.
///
/// A Gaussian of σ = 1 hardly distinguishes a pair at 0.4 mean spacings from one at 0.6. It raises
/// the smallest distance only by sharpening the whole set, which also raises the spectral peak. The
/// guard acts on the few pairs that are too close and on nothing else.
#[derive(Clone, Copy, Debug)]
pub struct Guard {
    /// r.
    reach: f64,
    /// s.
    strength: f64,
    /// 1/r².
    rate: f64,
}

impl Guard {
    /// A guard of range `reach` in mean spacings and of energy `strength` at distance 0.
    pub fn new(reach: f64, strength: f64) -> Self {
        Self {
            reach,
            strength,
            rate: 1.0 / (reach * reach),
        }
    }
}

impl PairEnergy for Guard {
    fn cutoff(&self) -> f64 {
        self.reach
    }

    #[inline]
    fn pair(&self, distance_squared: f64) -> (f64, f64) {
        let depth = (1.0 - distance_squared * self.rate).max(0.0);
        let pressed = self.strength * depth * depth;
        (pressed * depth, -6.0 * self.rate * pressed)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn slopes_are_twice_the_derivative_by_the_squared_distance(squared in 0.01f64..40.0, sigma in 0.6f64..1.2) {
            let energy = (Gaussian::new(sigma), Guard::new(0.8, 0.3));
            prop_assume!((squared - energy.cutoff() * energy.cutoff()).abs() > 1e-3);
            let h = 1e-5;
            let numeric = (energy.pair(squared + h).0 - energy.pair(squared - h).0) / h;
            prop_assert!((energy.pair(squared).1 - numeric).abs() < 1e-6);
        }

        #[test]
        fn nothing_acts_beyond_the_cutoff(excess in 0.0f64..1e6, sigma in 0.6f64..1.2) {
            let energy = (Gaussian::new(sigma), Guard::new(0.8, 0.3));
            let cutoff = energy.cutoff();
            prop_assert_eq!(energy.pair(cutoff * cutoff + excess), (0.0, 0.0));
        }
    }
}
