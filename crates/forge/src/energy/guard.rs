//! A guard against close pairs: E = Σ s·(1 − d²/r²)³ over pairs closer than r.
//!
//! A Gaussian of σ = 1 hardly distinguishes a pair at 0.4 mean spacings from one at 0.6. It raises
//! the smallest distance only by sharpening the whole set, which also raises the spectral peak. The
//! guard acts on the few pairs that are too close and on nothing else.

use super::PairEnergy;

/// Short-range repulsion that is 0 beyond its range.
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
    #[must_use]
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
    use crate::energy::Gaussian;

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
