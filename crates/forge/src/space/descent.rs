//! The steps of a job: the state between them, descent with momentum over the vectors of a table, and pushes, in which
//! points that are too near push each other apart until a target distance is kept everywhere.

use super::{
    energy::Gaussian,
    pairs::{Blocks, Pairs},
};

/// The vectors of a table in the making, and what the current phase has beside them: all that decides the next step.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SpaceState {
    /// Steps of the current phase.
    pub(crate) step: u32,
    /// The vectors, in mean spacings.
    pub(crate) moves: Vec<[f64; 3]>,
    /// Of a descent; empty in pushes.
    pub(crate) momentum: Vec<[f64; 3]>,
    /// The vectors that a descent's pairs were listed for, because the order of sums follows the lists; empty before the
    /// first step.
    pub(crate) listed: Vec<[f32; 3]>,
    /// Of pushes: the greatest least distance so far, and its vectors.
    pub(crate) least: f64,
    pub(crate) best: Vec<[f64; 3]>,
}

/// A descent of one energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Phase {
    /// The σ of the energy, in mean spacings.
    pub(super) sigma: f64,
    pub(super) steps: u32,
}

/// The part of the momentum that a step keeps.
const MOMENTUM: f64 = 0.95;
/// The longest step along an axis, in mean spacings.
const CLIP: f64 = 0.12;
/// Pairs are listed up to so much beyond the reach of the energy, and again once they may have come nearer.
const SKIN: f64 = 0.5;

/// A descent under way.
pub(super) struct Descent<'a> {
    blocks: &'a Blocks,
    phase: Phase,
    pairs: Pairs,
    forces: Vec<[f64; 3]>,
}

/// The vectors as the energy takes them.
pub(super) fn single(moves: &[[f64; 3]]) -> Vec<[f32; 3]> {
    moves.iter().map(|v| v.map(|v| v as f32)).collect()
}

impl<'a> Descent<'a> {
    pub(super) fn new(blocks: &'a Blocks, phase: Phase, state: &SpaceState) -> Self {
        let mut descent = Self {
            blocks,
            phase,
            pairs: Pairs::default(),
            forces: vec![[0.0; 3]; state.moves.len()],
        };
        if !state.listed.is_empty() {
            descent.pairs = blocks.pairs(&state.listed, descent.reach());
        }
        descent
    }

    fn reach(&self) -> f64 {
        Gaussian {
            sigma: self.phase.sigma,
        }
        .reach()
            + SKIN
    }

    /// Takes a step. Returns the energy before it, per point.
    pub(super) fn step(&mut self, state: &mut SpaceState) -> f64 {
        let moves = single(&state.moves);
        let is_near = state.listed.len() == moves.len()
            && moves.iter().zip(&state.listed).all(|(a, b)| {
                let squared: f32 = (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum();
                squared < (0.5 * SKIN * 0.5 * SKIN) as f32
            });
        if !is_near {
            self.pairs = self.blocks.pairs(&moves, self.reach());
            state.listed.clone_from(&moves);
        }
        let gaussian = Gaussian {
            sigma: self.phase.sigma,
        };
        let energy = gaussian.evaluate(self.blocks, &self.pairs, &moves, &mut self.forces);
        let rate = self.rate(state.step);
        state.momentum.resize(moves.len(), [0.0; 3]);
        for ((at, momentum), force) in state
            .moves
            .iter_mut()
            .zip(&mut state.momentum)
            .zip(&self.forces)
        {
            for axis in 0..3 {
                momentum[axis] = MOMENTUM * momentum[axis] + force[axis];
                let by = (rate * momentum[axis]).clamp(-CLIP, CLIP);
                momentum[axis] = by / rate;
                at[axis] += by;
            }
        }
        center(&self.blocks.shares, &mut state.moves);
        for v in &mut state.moves {
            let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
            if length > self.blocks.longest {
                *v = v.map(|v| v * (self.blocks.longest / length));
            }
        }
        state.step += 1;
        energy
    }

    /// Mean spacings per unit of momentum: it grows at first, and falls at the end.
    fn rate(&self, step: u32) -> f64 {
        let part = f64::from(step) / f64::from(self.phase.steps);
        let end = if part < 0.8 {
            1.0
        } else {
            1.0 - (part - 0.8) / 0.2 * 0.95
        };
        let start = (f64::from(step + 5) / 30.0).min(1.0);
        0.24 / self.phase.sigma.powi(3) * end * start
    }
}

/// Moves all points together, so that the mean of their vectors is 0.
fn center(shares: &[f64], moves: &mut [[f64; 3]]) {
    let mut mean = [0.0; 3];
    for (share, v) in shares.iter().zip(moves.iter()) {
        for axis in 0..3 {
            mean[axis] += share * v[axis];
        }
    }
    for v in moves {
        for axis in 0..3 {
            v[axis] -= mean[axis];
        }
    }
}

/// The target distances at the start and at the end, in mean spacings: 0.76 and 0.86 of the densest packing's.
const TARGETS: [f64; 2] = [0.853, 0.965];

/// Moves blocks apart, one step of `steps`. Returns the least distance before it, in mean spacings.
pub(super) fn push(blocks: &Blocks, state: &mut SpaceState, steps: u32) -> f64 {
    let part = f64::from(state.step) / f64::from(steps.max(2) - 1);
    let target = TARGETS[0] + (TARGETS[1] - TARGETS[0]) * part;
    let places = single(&state.moves);
    let mut sums = vec![([0.0f64; 3], 0.0f64); places.len()];
    let mut least = f64::INFINITY;
    blocks.each_pair(&places, target, |from, to, offset, _| {
        let d = [0, 1, 2].map(|axis| {
            f64::from(offset[axis]) * blocks.step + f64::from(places[to][axis])
                - f64::from(places[from][axis])
        });
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        least = least.min(length);
        if length > 1e-9 {
            let lack = target - length;
            let (sum, weight) = &mut sums[from];
            // The nearest pairs count most.
            let own = lack * lack;
            for axis in 0..3 {
                sum[axis] -= d[axis] / length * lack * own;
            }
            *weight += own;
        }
    });
    if least > state.least {
        (state.least, state.best) = (least, state.moves.clone());
    }
    for (v, (sum, weight)) in state.moves.iter_mut().zip(&sums) {
        if *weight > 0.0 {
            for axis in 0..3 {
                v[axis] += 0.55 * sum[axis] / weight;
            }
            let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
            if length > blocks.longest {
                *v = v.map(|v| v * (blocks.longest / length));
            }
        }
    }
    state.step += 1;
    least
}
