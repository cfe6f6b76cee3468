//! The two kinds of energies: sums over pairs of points, and any function of a periodic point set.

use rayon::prelude::*;

use crate::measure::{CellList, Sample};

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

/// A pair energy as a [`SetEnergy`]. It serves sets that have no table, and tests as the oracle of
/// [`Pairs`](crate::optimize::Pairs), which is faster.
#[derive(Clone, Copy, Debug)]
pub struct Pairwise<E>(pub E);

impl<E: PairEnergy> SetEnergy for Pairwise<E> {
    fn evaluate(&self, set: &Sample, gradient: &mut [[f64; 2]]) -> f64 {
        let cutoff = self.0.cutoff();
        let cells = CellList::of(set, (cutoff / 4.0).max(0.5));
        let rings = (cutoff / cells.width()).ceil() as i64;
        let each: Vec<(u32, f64, [f64; 2])> = cells
            .members()
            .par_iter()
            .map(|&(index, p)| {
                let (mut energy, mut slope) = (0.0, [0.0; 2]);
                for ring in 0..=rings {
                    cells.ring(p, ring, |other, [dx, dy]| {
                        let squared = dx * dx + dy * dy;
                        if other == index && squared == 0.0 {
                            return;
                        }
                        let (value, factor) = self.0.pair(squared);
                        energy += value;
                        slope[0] += factor * dx;
                        slope[1] += factor * dy;
                    });
                }
                (index, energy, slope)
            })
            .collect();
        let mut total = 0.0;
        for (index, energy, slope) in each {
            total += energy;
            gradient[index as usize] = slope;
        }
        0.5 * total / set.points().len().max(1) as f64
    }
}
