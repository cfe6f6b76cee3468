//! The joint polish of all levels: descent of the mean energy over shares, through the blend.
//!
//! The shares at which the energy is evaluated change with every step. Fixed ones would look perfect
//! and the shares between them would not.

use rayon::prelude::*;

use super::{
    climb::{Blocks, Climb, split},
    segment::{Energy, Lists, Slopes, slopes},
};

/// Mean spacings of the thinned set moved per unit of slope.
const RATE: f64 = 0.12;
/// The part of the last move that is repeated.
const MOMENTUM: f64 = 0.8;
/// The weight below which a vector is left alone: almost none of its points are looked at.
const LEAST_WEIGHT: f64 = 1e-3;
/// The longest move in a step, in mean spacings of the thinned set.
const LONGEST: f64 = 0.05;
/// The golden ratio: steps by it fill an interval evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// The state between steps.
pub(super) struct Polish {
    energy: Energy,
    /// Shares looked at in each segment.
    samples: usize,
    lists: Vec<Lists>,
    /// The vectors that the lists were made for.
    listed_for: Vec<[f64; 2]>,
    velocities: Vec<Vec<[f64; 2]>>,
}

impl Polish {
    pub(super) fn new(blocks: &Blocks, climb: &Climb, energy: Energy, samples: usize) -> Self {
        let velocities = climb.moves.iter().map(|level| vec![[0.0; 2]; level.len()]);
        let mut polish = Self {
            energy,
            samples,
            lists: Vec::new(),
            listed_for: Vec::new(),
            velocities: velocities.collect(),
        };
        polish.list(blocks, climb);
        polish
    }

    /// Makes the neighbor lists again.
    pub(super) fn list(&mut self, blocks: &Blocks, climb: &Climb) {
        self.lists = (0..climb.segments())
            .into_par_iter()
            .map(|segment| Lists::new(blocks, climb, segment, self.energy.cutoff()))
            .collect();
        self.listed_for = climb.moves.concat();
    }

    /// The vectors of all levels that the lists were made for.
    pub(super) fn listed_for(&self) -> Vec<[f64; 2]> {
        self.listed_for.clone()
    }

    /// The last moves of all vectors, one level after the other.
    pub(super) fn velocities(&self) -> Vec<[f64; 2]> {
        self.velocities.concat()
    }

    /// Replaces the last moves.
    pub(super) fn set_velocities(&mut self, velocities: &[[f64; 2]]) {
        let counts: Vec<usize> = self.velocities.iter().map(Vec::len).collect();
        self.velocities = split(velocities, &counts);
    }

    /// Takes step number `step`, with a rate in proportion to `pace`. Returns the energy before it.
    pub(super) fn step(&mut self, blocks: &Blocks, climb: &mut Climb, step: u32, pace: f64) -> f64 {
        let all: Vec<Slopes> = (0..climb.segments())
            .into_par_iter()
            .map(|segment| {
                // Another phase for each segment and step.
                let phase = (f64::from(step) + 0.37 * segment as f64) * GOLDEN;
                let phase = phase - phase.floor();
                let ways: Vec<f64> = (0..self.samples)
                    .map(|i| (i as f64 + phase) / self.samples as f64)
                    .collect();
                slopes(
                    blocks,
                    climb,
                    segment,
                    &self.lists[segment],
                    &self.energy,
                    &ways,
                )
            })
            .collect();
        for k in 1..climb.shares.len() {
            let longest = LONGEST / climb.shares[k].sqrt();
            let (above, below) = (&all[k - 1].of[1], all.get(k).map(|slopes| &slopes.of[0]));
            for (position, vector) in climb.moves[k].iter_mut().enumerate() {
                let [mut x, mut y, mut weight] = above[position];
                if let Some(more) = below.and_then(|below| below.get(position)) {
                    (x, y, weight) = (x + more[0], y + more[1], weight + more[2]);
                }
                if weight < LEAST_WEIGHT * self.samples as f64 {
                    continue;
                }
                let velocity = &mut self.velocities[k][position];
                let rate = RATE * pace / weight;
                for (axis, slope) in [x, y].into_iter().enumerate() {
                    velocity[axis] = MOMENTUM * velocity[axis] - rate * slope;
                }
                let length = (velocity[0] * velocity[0] + velocity[1] * velocity[1]).sqrt();
                if length > longest {
                    velocity[0] *= longest / length;
                    velocity[1] *= longest / length;
                }
                vector[0] += velocity[0];
                vector[1] += velocity[1];
            }
        }
        all.iter().map(|slopes| slopes.energy).sum::<f64>() / all.len() as f64
    }
}
