//! Joint tables: the vectors of a table moved so that all its points and those of each kind of a mix are blue, by the
//! energy of all points together and of each kind.

use strew_core::{
    Table,
    table::{Displacement, Mix},
};

use super::{
    clear::{Floor, clear},
    each,
    part::Part,
};
use crate::{
    energy::{Gaussian, Guard, PairEnergy},
    optimize::{Descent, DescentState, Ground, Objective, Pairs, longest, moves_of},
    phase::work_off,
    watch::Meter,
};

/// Mean spacings moved per unit of gradient.
const RATE: f64 = 0.2;
/// The least δ of all points and of a kind: more than what is promised, because the warps of seeds bring some
/// pairs nearer, by 4 percent in windows of 60,000 points.
const FLOOR: Floor = Floor {
    all: 0.58,
    kind: 0.62,
};
/// The most rounds of pushing near pairs apart.
const ROUNDS: usize = 200;

/// The moved vectors of a table, or `None` if the meter's watch stopped the work. It takes `steps` steps.
pub(super) fn moved(
    table: &Table,
    mix: &Mix,
    steps: u32,
    meter: &mut Meter<'_>,
) -> Option<Vec<Displacement>> {
    let shares = each(mix.shares());
    let kinds = parts(table, mix);
    let energy = Together::new(table, &shares, &kinds);
    let mut descent = Descent::new(energy, steps, RATE);
    let mut state = DescentState::start(moves_of(table));
    if !work_off(&mut descent, &mut state, meter, &mut |_| {}) {
        return None;
    }
    let (mut moves, ground) = (state.moves, &descent.objective.ground);
    clear(ground, &kinds, &shares, &mut moves, FLOOR, ROUNDS);
    let unit = table.alpha().set_side_f64() / f64::from(1u32 << 20);
    let fixed = |move_: &[f64; 2]| move_.map(|v| (v / unit).round() as i32);
    Some(moves.iter().map(fixed).collect())
}

/// The part of each block that is of each kind, kind by kind.
pub(super) fn parts(table: &Table, mix: &Mix) -> Vec<Vec<f64>> {
    let map = table.map();
    let mut parts = vec![vec![0.0; mix.labels().len()]; mix.shares().kinds()];
    for (block, &kind) in mix.labels().iter().enumerate() {
        parts[usize::from(kind)][block] = 1.0;
    }
    for split in mix.splits() {
        let block = split.block as usize;
        let interval = map.interval(block % map.intervals());
        let part = split.offset as f64 / (interval.end - interval.start) as f64;
        parts[usize::from(mix.labels()[block])][block] = part;
        parts[usize::from(split.kind)][block] = 1.0 - part;
    }
    parts
}

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
        let ground = Ground::new(map, range + 2.0 * (longest(&moves_of(table)) + GROWTH));
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
    use super::*;
    use crate::optimize::{check_slopes, jitter};

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
        let split = mix.splits()[0].block as usize;
        check_slopes(&mut energy, &moves, &[0, 3, blocks / 2, split]);
    }
}
