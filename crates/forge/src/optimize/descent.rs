//! Gradient descent with momentum.

use super::{DescentState, Objective};
use crate::{
    ForgeError,
    phase::{Phase, State as _},
};

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
    #[must_use]
    pub const fn new(objective: O, steps: u32, rate: f64) -> Self {
        Self {
            objective,
            steps,
            rate,
            gradient: Vec::new(),
        }
    }
}

impl<O: Objective> Phase<DescentState> for Descent<O> {
    fn steps(&self) -> u32 {
        self.steps
    }

    fn describe(&self) -> String {
        format!("{} steps at rate {}", self.steps, self.rate)
    }

    fn begin(&mut self, state: &DescentState) {
        if !state.prepared_for.is_empty() {
            self.objective.prepare_for(&state.prepared_for);
        }
        self.gradient = vec![[0.0; 2]; state.blocks()];
    }

    fn step(&mut self, state: &mut DescentState) -> f64 {
        let energy = self.objective.evaluate(&state.ahead, &mut self.gradient);
        state.step(self.rate, energy, &self.gradient, self.objective.masses());
        energy
    }

    fn complete(&self, state: &mut DescentState) {
        self.objective
            .prepared_for()
            .clone_into(&mut state.prepared_for);
    }

    fn end(&self, state: DescentState) -> Result<DescentState, ForgeError> {
        Ok(DescentState::start(state.moves))
    }

    fn pairs(&self) -> usize {
        self.objective.pairs()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;
    use crate::{
        phase::work_off,
        watch::{Meter, Progress, Stage, Watch},
    };

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

    fn run(steps: u32, rate: f64, watch: &dyn Watch) -> DescentState {
        let mut meter = Meter::new(watch, Stage::Optimizing, steps);
        let mut state = DescentState::start(vec![[5.0, 5.0]; 2]);
        let mut descent = Descent::new(Valley([0.25, 0.75]), steps, rate);
        work_off(&mut descent, &mut state, &mut meter, &mut |_| {});
        state
    }

    #[test]
    fn reaches_the_bottom_of_a_narrow_valley_also_with_a_rate_that_is_too_large() {
        for (rate, most) in [(0.9, 1e-6), (50.0, 0.02)] {
            let found = run(600, rate, &());
            assert!(found.energy < most, "{rate}: {}", found.energy);
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
