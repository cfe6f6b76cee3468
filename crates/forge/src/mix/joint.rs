//! Joint tables: the vectors of a table moved so that all its points and those of each kind of a mix are blue, by the
//! energy of all points together and of each kind at its own density.

use rayon::prelude::*;
use strew_core::{
    Table,
    table::{Displacement, Mix},
};

use super::{
    clear::{Floor, clear},
    press::each,
};
use crate::{
    checkpoint::State,
    energy::{Gaussian, Guard, PairEnergy},
    optimize::{CHUNK, Descent, Ground, Objective, Pair, Pairs, fill, longest, moves_of, sum},
    watch::{Meter, work_off},
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
    let mut state = State::start(moves_of(table).into_flattened());
    if !work_off(&mut descent, &mut state, meter, &mut |_| {}) {
        return None;
    }
    let (moves, ground) = (state.moves.as_chunks_mut().0, &descent.objective.ground);
    clear(ground, &kinds, &shares, moves, FLOOR, ROUNDS);
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

/// The points of one kind.
pub(super) struct Part<E> {
    energy: E,
    share: f64,
    /// Its blocks, ascending, and which part of each is of the kind.
    blocks: Vec<(u32, f64)>,
    /// By block; 0 for those of other kinds.
    weights: Vec<f64>,
    /// The pairs of each of its blocks. Their weights count points of the kind only.
    lists: Vec<Vec<Pair>>,
    built_for: Vec<[f64; 2]>,
}

impl<E: PairEnergy> Part<E> {
    /// Lists reach this far beyond the cut-off, in the kind's own spacings, and stay valid until some block has
    /// moved by half of it.
    pub(super) const SKIN: f64 = 0.3;

    /// The kind that has these parts of the blocks.
    pub(super) fn new(energy: E, ground: &Ground, weights: Vec<f64>) -> Self {
        let blocks: Vec<(u32, f64)> = (0..)
            .zip(&weights)
            .filter_map(|(block, &weight)| (weight > 0.0).then_some((block, weight)))
            .collect();
        let share = blocks.iter().map(|&(b, w)| w * ground.shares[b as usize]);
        Self {
            energy,
            share: share.sum(),
            blocks,
            weights,
            lists: Vec::new(),
            built_for: Vec::new(),
        }
    }

    /// Adds `factor` times the gradient of the energy per point of the kind, divided by the masses of
    /// blocks. Returns the energy per point.
    pub(super) fn add(
        &mut self,
        ground: &Ground,
        moves: &[[f64; 2]],
        factor: f64,
        gradient: &mut [[f64; 2]],
    ) -> f64 {
        if self.is_stale(moves) {
            self.build(ground, moves);
        }
        let sums: Vec<(f64, [f64; 2])> = (0..self.blocks.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|at| self.sum(ground, moves, at))
            .collect();
        let mut energy = 0.0;
        for (&(block, weight), (value, slope)) in self.blocks.iter().zip(&sums) {
            let block = block as usize;
            energy += ground.shares[block] * weight * value;
            // Slopes are by distances in the kind's own spacings squared.
            let by = factor * weight;
            for axis in 0..2 {
                gradient[block][axis] += by * slope[axis];
            }
        }
        0.5 * energy / self.share
    }

    fn is_stale(&self, moves: &[[f64; 2]]) -> bool {
        let limit = Self::SKIN * Self::SKIN / 4.0 / self.share;
        self.built_for.len() != moves.len()
            || self.blocks.iter().any(|&(block, _)| {
                let (a, b) = (moves[block as usize], self.built_for[block as usize]);
                let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
                dx * dx + dy * dy > limit
            })
    }

    fn build(&mut self, ground: &Ground, moves: &[[f64; 2]]) {
        let range = (self.energy.cutoff() + Self::SKIN) / self.share.sqrt();
        let moved = (moves, longest(moves));
        let list = |&(block, _): &(u32, f64)| {
            let (block, mut list) = (block as usize, Vec::with_capacity(128));
            let is_of_kind = |to: usize| self.weights[to] > 0.0;
            ground.near(block, moved, range, is_of_kind, |meet, _| {
                let part = self.weights[meet.to as usize] as f32;
                let weight = ground.weight(block, &meet) * part;
                let (to, i, j) = (meet.to, meet.i, meet.j);
                list.push(Pair { to, i, j, weight });
            });
            fill(&mut list);
            list
        };
        let lists: Vec<Vec<Pair>> = self.blocks.par_iter().map(list).collect();
        self.lists = lists;
        self.built_for = moves.to_vec();
    }

    /// The energy of an instance of a block and its slopes.
    fn sum(&self, ground: &Ground, moves: &[[f64; 2]], at: usize) -> (f64, [f64; 2]) {
        let own = moves[self.blocks[at].0 as usize];
        let pair = |squared| self.energy.pair(squared * self.share);
        sum(&self.lists[at], ground.scale, moves, own, pair)
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
