//! The energy of one kind as a function of a table's vectors, at its own density.

use rayon::prelude::*;

use crate::{
    energy::PairEnergy,
    optimize::{CHUNK, Ground, Pair, fill, longest, sum},
};

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
