//! The phases of a job: descent with momentum over the vectors of a table, and pushes, in
//! which points that are too near push each other apart until a target distance is kept everywhere.

use strew_core::Map;

use super::pairs::{Blocks, Gaussian, Pairs};
use crate::{ForgeError, State, checkpoint::vectors, watch::Phase};

/// How the steps of a phase move blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Rule {
    /// Down the energy of a Gaussian.
    Descent(Gaussian),
    /// Near points apart.
    Pushes,
}

/// The part of the momentum that a step keeps.
const MOMENTUM: f64 = 0.95;
/// The longest step along an axis, in mean spacings.
const CLIP: f64 = 0.12;
/// Pairs are listed up to so much beyond the reach of the energy, and again once they may have come nearer.
const SKIN: f64 = 0.5;

/// A phase of a job.
pub(super) struct SpacePhase<'a> {
    rule: Rule,
    steps: u32,
    blocks: Blocks,
    /// The map of the phase and that of the next one, if that is finer.
    finer: Option<&'a [Map; 2]>,
    pairs: Pairs,
    forces: Vec<[f64; 3]>,
}

/// The vectors as the energy takes them.
fn single(moves: &[f64]) -> Vec<[f32; 3]> {
    let moves = vectors::<3>(moves).iter();
    moves.map(|v| v.map(|v| v as f32)).collect()
}

impl<'a> SpacePhase<'a> {
    pub(super) fn new(rule: Rule, steps: u32, map: &Map, finer: Option<&'a [Map; 2]>) -> Self {
        // The distance within which the blocks must know each other, in mean spacings.
        let reach = match rule {
            Rule::Descent(_) => 5.6,
            Rule::Pushes => 1.3,
        };
        Self {
            rule,
            steps,
            blocks: Blocks::new(map, reach),
            finer,
            pairs: Pairs::default(),
            forces: Vec::new(),
        }
    }

    /// Takes a step down an energy. Returns the energy before it, per point.
    fn descend(&mut self, gaussian: Gaussian, state: &mut State) -> f64 {
        let moves = single(&state.moves);
        let [momentum, listed, _] = &mut state.lists;
        let is_near = listed.len() == state.moves.len()
            && moves.iter().zip(single(listed)).all(|(a, b)| {
                let squared: f32 = (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum();
                squared < (0.5 * SKIN * 0.5 * SKIN) as f32
            });
        if !is_near {
            self.pairs = self.blocks.pairs(&moves, gaussian.reach() + SKIN);
            listed.clone_from(&state.moves);
        }
        let energy = gaussian.evaluate(&self.blocks, &self.pairs, &moves, &mut self.forces);
        let rate = self.rate(gaussian, state.steps);
        momentum.resize(state.moves.len(), 0.0);
        let all = state.moves.iter_mut().zip(momentum);
        for ((at, momentum), force) in all.zip(self.forces.as_flattened()) {
            *momentum = MOMENTUM * *momentum + force;
            let by = (rate * *momentum).clamp(-CLIP, CLIP);
            *momentum = by / rate;
            *at += by;
        }
        let (moves, _) = state.moves.as_chunks_mut();
        center(&self.blocks.shares, moves);
        shorten(moves, self.blocks.longest);
        energy
    }

    /// Mean spacings per unit of momentum: it grows at first, and falls at the end.
    fn rate(&self, gaussian: Gaussian, step: u32) -> f64 {
        let part = f64::from(step) / f64::from(self.steps);
        let end = if part < 0.8 {
            1.0
        } else {
            1.0 - (part - 0.8) / 0.2 * 0.95
        };
        let start = (f64::from(step + 5) / 30.0).min(1.0);
        0.24 / gaussian.sigma.powi(3) * end * start
    }
}

/// The lists of a state are the momentum of a descent, the vectors that its pairs were listed for, because the order of sums
/// follows the lists, and of pushes the vectors with the greatest least distance so far, which is a number of the state.
impl Phase for SpacePhase<'_> {
    fn steps(&self) -> u32 {
        self.steps
    }

    fn describe(&self) -> String {
        match self.rule {
            Rule::Descent(Gaussian { sigma }) => format!("{} steps at sigma {sigma}", self.steps),
            Rule::Pushes => format!("{} pushes", self.steps),
        }
    }

    fn begin(&mut self, state: &mut State) {
        self.forces = vec![[0.0; 3]; state.moves.len() / 3];
        let [_, listed, _] = &state.lists;
        if let (Rule::Descent(gaussian), false) = (self.rule, listed.is_empty()) {
            let reach = gaussian.reach() + SKIN;
            self.pairs = self.blocks.pairs(&single(listed), reach);
        }
    }

    fn step(&mut self, state: &mut State) -> f64 {
        let value = match self.rule {
            Rule::Descent(gaussian) => self.descend(gaussian, state),
            Rule::Pushes => push(&self.blocks, state, self.steps),
        };
        state.steps += 1;
        value
    }

    fn end(&self, state: State) -> Result<State, ForgeError> {
        let [_, _, best] = state.lists;
        let mut moves = if best.is_empty() { state.moves } else { best };
        if let Some([coarse, fine]) = self.finer {
            // The vectors of the coarse map for the blocks of the finer one.
            let (fine, parents) = coarse.refine(fine.radius())?;
            let (n, m) = (fine.intervals(), coarse.intervals());
            let coarse = vectors::<3>(&moves);
            let parent = |b: usize| {
                let [i, j, k] = [b % n, b / n % n, b / (n * n)].map(|i| parents[i]);
                coarse[(k * m + j) * m + i]
            };
            moves = (0..n.pow(3)).flat_map(parent).collect();
        }
        Ok(State::start(moves))
    }

    fn pairs(&self) -> usize {
        self.pairs.blocks.len()
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

/// Shortens vectors that are too long.
fn shorten(moves: &mut [[f64; 3]], longest: f64) {
    for v in moves {
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        if length > longest {
            *v = v.map(|v| v * (longest / length));
        }
    }
}

/// The target distances at the start and at the end, in mean spacings: 0.76 and 0.86 of the densest packing's.
const TARGETS: [f64; 2] = [0.853, 0.965];

/// Moves blocks apart, one step of `steps`. Returns the least distance before it, in mean spacings.
fn push(blocks: &Blocks, state: &mut State, steps: u32) -> f64 {
    let part = f64::from(state.steps) / f64::from(steps.max(2) - 1);
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
    if least > state.numbers[0] {
        (state.numbers[0], state.lists[2]) = (least, state.moves.clone());
    }
    let (moves, _) = state.moves.as_chunks_mut::<3>();
    for (v, (sum, weight)) in moves.iter_mut().zip(&sums) {
        if *weight > 0.0 {
            for axis in 0..3 {
                v[axis] += 0.55 * sum[axis] / weight;
            }
            shorten(std::slice::from_mut(v), blocks.longest);
        }
    }
    least
}
