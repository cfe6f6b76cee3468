//! What a descent lowers, its random start, and its state between two steps.

use crate::{checkpoint::Kept, numeric::SplitMix, phase::State};

/// The state of a descent between two steps. A descent resumed from it takes the same steps, bit
/// for bit, as one that was not stopped.
#[derive(Clone, Debug, PartialEq)]
pub struct DescentState {
    /// The moves with the lowest energy so far.
    pub moves: Vec<[f64; 2]>,
    /// The energy of `moves`, per point.
    pub energy: f64,
    /// The number of evaluations done.
    pub steps: u32,
    /// The energy of the last evaluation; infinite before the first and after a restart.
    last: f64,
    /// Steps since the momentum was last dropped.
    age: f64,
    /// The current rate over the first one.
    slowing: f64,
    /// The moves after the last step, without momentum.
    at: Vec<[f64; 2]>,
    /// The moves after the last step, with momentum: where the next evaluation takes place.
    pub(super) ahead: Vec<[f64; 2]>,
    /// The moves that the objective built its lists for; see
    /// [`Objective::prepared_for`].
    pub(super) prepared_for: Vec<[f64; 2]>,
}

impl DescentState {
    /// The state before any step.
    #[must_use]
    pub fn start(moves: Vec<[f64; 2]>) -> Self {
        Self {
            energy: f64::INFINITY,
            steps: 0,
            last: f64::INFINITY,
            age: 0.0,
            slowing: 1.0,
            at: moves.clone(),
            ahead: moves.clone(),
            prepared_for: Vec::new(),
            moves,
        }
    }

    /// Takes a step, given the energy and its gradient at `ahead`.
    pub(super) fn step(
        &mut self,
        first_rate: f64,
        energy: f64,
        gradient: &[[f64; 2]],
        masses: &[f64],
    ) {
        self.steps += 1;
        if energy < self.energy {
            self.energy = energy;
            self.moves.clone_from(&self.ahead);
        }
        // If the energy rises, restart from the best moves. Without momentum to blame, the step was
        // too long.
        let rose = energy > self.last || energy.is_nan();
        self.last = energy;
        if rose {
            self.slowing *= if self.age <= 1.0 { 0.5 } else { 1.0 };
            (self.age, self.last) = (0.0, f64::INFINITY);
            self.at.clone_from(&self.moves);
            self.ahead.clone_from(&self.moves);
            return;
        }
        let rate = first_rate * self.slowing;
        let mut uphill = 0.0;
        self.age += 1.0;
        let momentum = self.age / (self.age + 3.0);
        let places = self.at.iter_mut().zip(&mut self.ahead);
        for (((at, ahead), slope), mass) in places.zip(gradient).zip(masses) {
            for axis in 0..2 {
                let next = ahead[axis] - rate * slope[axis];
                let by = next - at[axis];
                uphill += mass * slope[axis] * by;
                at[axis] = next;
                ahead[axis] = next + momentum * by;
            }
        }
        if uphill > 0.0 {
            self.age = 0.0;
            self.ahead.clone_from(&self.at);
        }
    }
}

impl State for DescentState {
    fn steps(&self) -> u32 {
        self.steps
    }

    fn blocks(&self) -> usize {
        self.moves.len()
    }

    fn keep(&self) -> Kept {
        let lists = [&self.moves, &self.at, &self.ahead, &self.prepared_for];
        Kept {
            steps: self.steps,
            numbers: vec![self.energy, self.last, self.age, self.slowing],
            lists: lists.map(|list| list.as_flattened().to_vec()).into(),
        }
    }

    fn resume(kept: Kept) -> Option<Self> {
        let (steps, numbers) = (kept.steps, kept.numbers[..].try_into());
        let [energy, last, age, slowing]: [f64; 4] = numbers.ok()?;
        let [moves, at, ahead, prepared_for] = kept.lists()?;
        Some(Self {
            moves,
            energy,
            steps,
            last,
            age,
            slowing,
            at,
            ahead,
            prepared_for,
        })
    }
}

/// Returns a vector for each block, uniformly random in a square or cube of half-width `jitter`.
///
/// The half-width should be small: from a large random start, pairs of blocks that seldom meet
/// settle on top of each other.
#[must_use]
pub fn jitter<const D: usize>(blocks: usize, jitter: f64, seed: u64) -> Vec<[f64; D]> {
    let mut random = SplitMix::new(seed);
    let mut next = || (2.0 * random.next_f64() - 1.0) * jitter;
    (0..blocks)
        .map(|_| std::array::from_fn(|_| next()))
        .collect()
}

/// An energy as a function of a table's vectors, which are in mean spacings and called *moves*.
pub trait Objective {
    /// The share of the points that each block has. The shares sum to 1.
    fn masses(&self) -> &[f64];

    /// Returns the energy per point. Writes into `gradient`, for each block, the derivative by the
    /// position of one instance, averaged over its instances; the product with the mass of the
    /// block is the derivative by its vector.
    ///
    /// Must return the same bits with any number of threads.
    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64;

    /// The moves that the neighbor lists were built for; empty if there are no lists. The order of
    /// sums follows the lists, so the bits of the next evaluation depend on them.
    fn prepared_for(&self) -> &[[f64; 2]] {
        &[]
    }

    /// Builds the neighbor lists for these moves, to resume a descent with the same lists.
    fn prepare_for(&mut self, moves: &[[f64; 2]]) {
        let _ = moves;
    }

    /// The number of pairs that an evaluation visits, known after the first; 0 if it visits none.
    fn pairs(&self) -> usize {
        0
    }
}

/// Checks the slopes of some blocks against differences of the energy.
#[cfg(test)]
pub(crate) fn check_slopes(of: &mut impl Objective, moves: &[[f64; 2]], blocks: &[usize]) {
    let mut gradient = vec![[0.0; 2]; moves.len()];
    of.evaluate(moves, &mut gradient);
    for (&block, axis) in blocks.iter().flat_map(|block| [(block, 0), (block, 1)]) {
        let mut at = |by: f64| {
            let mut moves = moves.to_vec();
            moves[block][axis] += by;
            of.evaluate(&moves, &mut vec![[0.0; 2]; moves.len()])
        };
        let numeric = (at(1e-6) - at(-1e-6)) / 2e-6;
        let found = gradient[block][axis] * of.masses()[block];
        let error = (found - numeric).abs();
        assert!(
            error < 1e-4 * numeric.abs().max(1e-4),
            "{block}: {found} {numeric}"
        );
    }
}
