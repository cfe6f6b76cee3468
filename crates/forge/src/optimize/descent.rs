//! Gradient descent with momentum: what it lowers, and its random start.

use crate::{ForgeError, State, checkpoint::vectors, numeric::SplitMix, watch::Phase};

/// Returns a vector for each block, uniformly random in a square or cube of half-width `jitter`.
///
/// The half-width should be small: from a large random start, pairs of blocks that seldom meet
/// settle on top of each other.
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

/// A phase that lowers an objective, from a start or from where a descent was stopped.
///
/// This is Nesterov's method with adaptive restart (O'Donoghue, Candès 2015): the momentum is
/// dropped whenever it points uphill. It grows to what the flat directions of the energy need,
/// so nothing has to be tuned to them.
pub struct Descent<O> {
    pub(crate) objective: O,
    /// The number of evaluations.
    steps: u32,
    /// Mean spacings moved per unit of gradient, at first. It is halved whenever a step without
    /// momentum raises the energy.
    rate: f64,
    gradient: Vec<[f64; 2]>,
}

impl<O: Objective> Descent<O> {
    /// A descent of some steps. `rate` is in mean spacings moved per unit of gradient, at first: it is halved whenever a step
    /// without momentum raises the energy.
    pub const fn new(objective: O, steps: u32, rate: f64) -> Self {
        Self {
            objective,
            steps,
            rate,
            gradient: Vec::new(),
        }
    }
}

/// Takes a step, given the energy and its gradient where it was evaluated.
fn step(state: &mut State, first_rate: f64, energy: f64, gradient: &[[f64; 2]], masses: &[f64]) {
    // The energy of the best moves; that of the last evaluation, infinite before the first and after a restart; the steps since
    // the momentum was last dropped; and the current rate over the first one.
    let [least, last, age, slowing] = &mut state.numbers;
    let [at, ahead, _] = &mut state.lists;
    state.steps += 1;
    if energy < *least {
        *least = energy;
        state.moves.clone_from(ahead);
    }
    // If the energy rises, restart from the best moves. Without momentum to blame, the step was
    // too long.
    let rose = energy > *last || energy.is_nan();
    *last = energy;
    if rose {
        *slowing *= if *age <= 1.0 { 0.5 } else { 1.0 };
        (*age, *last) = (0.0, f64::INFINITY);
        at.clone_from(&state.moves);
        ahead.clone_from(&state.moves);
        return;
    }
    let rate = first_rate * *slowing;
    let mut uphill = 0.0;
    *age += 1.0;
    let momentum = *age / (*age + 3.0);
    let slopes = gradient.as_flattened().iter();
    let masses = masses.iter().flat_map(|mass| [mass; 2]);
    let places = at.iter_mut().zip(&mut *ahead);
    for (((at, ahead), slope), mass) in places.zip(slopes).zip(masses) {
        let next = *ahead - rate * slope;
        let by = next - *at;
        uphill += mass * slope * by;
        *at = next;
        *ahead = next + momentum * by;
    }
    if uphill > 0.0 {
        *age = 0.0;
        ahead.clone_from(at);
    }
}

/// The lists of a state are the moves after the last step, without momentum and with it, where the next evaluation takes
/// place, and those that the objective built its lists for; see [`Objective::prepared_for`].
impl<O: Objective> Phase for Descent<O> {
    fn steps(&self) -> u32 {
        self.steps
    }

    fn describe(&self) -> String {
        format!("{} steps at rate {}", self.steps, self.rate)
    }

    fn begin(&mut self, state: &mut State) {
        let moves = &state.moves;
        self.gradient = vec![[0.0; 2]; moves.len() / 2];
        if state.lists[0].is_empty() {
            state.numbers = [f64::INFINITY, f64::INFINITY, 0.0, 1.0];
            state.lists = [moves.clone(), moves.clone(), Vec::new()];
        }
        if !state.lists[2].is_empty() {
            self.objective.prepare_for(vectors(&state.lists[2]));
        }
    }

    fn step(&mut self, state: &mut State) -> f64 {
        let at = vectors(&state.lists[1]);
        let energy = self.objective.evaluate(at, &mut self.gradient);
        let masses = self.objective.masses();
        step(state, self.rate, energy, &self.gradient, masses);
        energy
    }

    fn complete(&self, state: &mut State) {
        state.lists[2] = self.objective.prepared_for().as_flattened().to_vec();
    }

    fn end(&self, state: State) -> Result<State, ForgeError> {
        Ok(State::start(state.moves))
    }

    fn pairs(&self) -> usize {
        self.objective.pairs()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;
    use crate::watch::{Meter, Progress, Stage, Watch, work_off};

    /// A narrow valley: curvatures 1 and 0.002 per mass.
    struct Valley([f64; 2]);

    impl Objective for Valley {
        fn masses(&self) -> &[f64] {
            &self.0
        }

        fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
            let mut energy = 0.0;
            for ((m, g), mass) in moves.iter().zip(gradient).zip(self.0) {
                *g = [m[0] - 1.0, 0.002 * (m[1] + 2.0)];
                energy += mass * 0.5 * ((m[0] - 1.0) * g[0] + (m[1] + 2.0) * g[1]);
            }
            energy
        }
    }

    fn run(steps: u32, rate: f64, watch: &dyn Watch) -> State {
        let mut meter = Meter::new(watch, Stage::Optimizing, steps);
        let mut state = State::start(vec![5.0; 4]);
        let mut descent = Descent::new(Valley([0.25, 0.75]), steps, rate);
        work_off(&mut descent, &mut state, &mut meter, &mut |_| {});
        state
    }

    #[test]
    fn reaches_the_bottom_of_a_narrow_valley_also_with_a_rate_that_is_too_large() {
        for (rate, most) in [(0.9, 1e-6), (50.0, 0.02)] {
            let found = run(600, rate, &());
            let [energy, ..] = found.numbers;
            assert!(energy < most, "{rate}: {energy}");
            assert_eq!(found.steps, 600);
        }
    }

    #[test]
    fn a_stopped_descent_returns_the_best_so_far() {
        struct Impatient(AtomicU32);
        impl Watch for Impatient {
            fn progress(&self, progress: &Progress) {
                assert_eq!(progress.steps, 100);
                self.0.store(progress.step, Ordering::Relaxed);
            }

            fn stop(&self) -> bool {
                self.0.load(Ordering::Relaxed) >= 7
            }
        }
        let found = run(100, 0.9, &Impatient(AtomicU32::new(0)));
        assert_eq!(found.steps, 7);
        assert_eq!(found.moves, run(7, 0.9, &()).moves);
    }
}
