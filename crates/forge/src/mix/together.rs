//! The energy of all points together and of each kind, as a function of a table's vectors.

use strew_core::Table;

use super::{part::Part, press::longest};
use crate::{
    energy::{Gaussian, Guard, PairEnergy},
    optimize::{Objective, Pairs},
    thinned::Ground,
};

type Law = (Gaussian, Guard);

/// σ of all points, in mean spacings. Below 0.95 kinds of the shares 1:3 crystallize: they are a sublattice of
/// the hexagonal lattice.
const SIGMA: f64 = 1.0;
/// σ of a kind, in its own spacings.
const SIGMA_OF_KIND: f64 = 0.85;
/// The cut-offs of guards, for all points and for a kind, and their strength.
const GUARD: (f64, f64) = (0.6, 0.6);
const GUARD_OF_KIND: (f64, f64) = (0.75, 0.5);
/// The weight of the energy of all points.
const WEIGHT: f64 = 20.0;
/// The weight of a kind's energy goes with this power of its share, and the densest has 1.
const TILT: f64 = 0.15;
/// The bound of displacements, in mean spacings.
const GROWTH: f64 = 4.0;

/// The energy of all points and of each kind.
pub(super) struct Together {
    ground: Ground,
    all: Pairs<Law>,
    /// The kinds, each with its weight.
    kinds: Vec<(f64, Part<Law>)>,
}

impl Together {
    /// The energies of a table's points, of kinds that have a part of each block; shares ascend.
    pub(super) fn new(table: &Table, shares: &[f64], kinds: &[Vec<f64>]) -> Self {
        let law = |sigma, (reach, strength)| (Gaussian::new(sigma), Guard::new(reach, strength));
        let (all, kind) = (law(SIGMA, GUARD), law(SIGMA_OF_KIND, GUARD_OF_KIND));
        let map = table.map();
        let range = (kind.cutoff() + Part::<Law>::SKIN) / shares[0].sqrt();
        let ground = Ground::new(map, range + 2.0 * (longest(table) + GROWTH));
        let densest = shares[shares.len() - 1];
        let parts = shares.iter().zip(kinds).map(|(share, parts)| {
            let part = Part::new(kind, &ground, parts.clone());
            (libm::pow(share / densest, TILT), part)
        });
        Self {
            all: Pairs::new(all, std::slice::from_ref(map), map.alpha().set_side_f64()),
            kinds: parts.collect(),
            ground,
        }
    }

    /// The blocks that meet, with frequencies.
    pub(super) const fn ground(&self) -> &Ground {
        &self.ground
    }
}

impl Objective for Together {
    fn masses(&self) -> &[f64] {
        self.all.masses()
    }

    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        // Over the sum of the weights, so that one rate serves all.
        let whole = WEIGHT + 1.0;
        let mut energy = self.all.evaluate(moves, gradient) * WEIGHT / whole;
        for slope in gradient.iter_mut().flatten() {
            *slope *= WEIGHT / whole;
        }
        for (weight, part) in &mut self.kinds {
            let weight = *weight / whole;
            energy += weight * part.add(&self.ground, moves, weight, gradient);
        }
        energy
    }
}

#[cfg(test)]
mod tests {
    use strew_core::table::Mix;

    use super::*;
    use crate::{mix::joint::parts, optimize::jitter, thinned::moves_of};

    #[test]
    fn slopes_are_those_of_the_energy() {
        let alpha = "(5-sqrt(3))/2".parse().expect("valid");
        let table = Table::undisplaced(alpha, 9, "pattern").expect("small");
        let mix = Mix::scattered(table.map(), "1:2".parse().expect("valid")).expect("near");
        let kinds = parts(&table, &mix);
        let mut energy = Together::new(&table, &[1.0 / 3.0, 2.0 / 3.0], &kinds);
        let blocks = mix.labels().len();
        let mut moves = moves_of(&table);
        for (to, by) in moves.iter_mut().zip(jitter::<2>(blocks, 0.4, 5)) {
            *to = [to[0] + by[0], to[1] + by[1]];
        }
        let mut slopes = vec![[0.0; 2]; blocks];
        let mut unused = slopes.clone();
        energy.evaluate(&moves, &mut slopes);
        let masses = energy.masses().to_vec();
        let split = mix.splits()[0].block as usize;
        for block in [0, 3, blocks / 2, split] {
            for axis in 0..2 {
                let step = 1e-4;
                let mut at = |by: f64| {
                    let mut moves = moves.clone();
                    moves[block][axis] += by;
                    energy.evaluate(&moves, &mut unused)
                };
                let numeric = (at(step) - at(-step)) / (2.0 * step);
                let found = slopes[block][axis] * masses[block];
                assert!((found - numeric).abs() < 1e-6, "{block}: {found} {numeric}");
            }
        }
    }
}
