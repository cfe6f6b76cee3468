//! A pair energy on a point set, summed over its pairs.

use rayon::prelude::*;

use super::{PairEnergy, SetEnergy};
use crate::measure::{CellList, Sample};

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
