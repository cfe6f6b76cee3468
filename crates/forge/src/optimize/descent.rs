//! Gradient descent with momentum.

use super::{DescentState, Objective};
use crate::watch::Meter;

/// The parameters of a descent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Descent {
    /// The number of evaluations.
    pub steps: u32,
    /// Mean spacings moved per unit of gradient, at first. It is halved whenever a step without
    /// momentum raises the energy.
    pub rate: f64,
}

impl Descent {
    /// Lowers the energy of `objective`, from a start or from where a descent was stopped.
    ///
    /// This is Nesterov's method with adaptive restart (O'Donoghue, Candès 2015): the momentum is
    /// dropped whenever it points uphill. It grows to what the flat directions of the energy need,
    /// so nothing has to be tuned to them.
    ///
    /// Calls `keep` with the state between two steps when the watch wants a checkpoint and when it
    /// stops the descent, which then returns with fewer than `self.steps` steps done.
    pub fn run(
        &self,
        objective: &mut (impl Objective + ?Sized),
        start: DescentState,
        meter: &mut Meter<'_>,
        keep: &mut dyn FnMut(&DescentState),
    ) -> DescentState {
        let masses = objective.masses().to_vec();
        let mut state = start;
        if !state.prepared_for.is_empty() {
            objective.prepare_for(&state.prepared_for);
        }
        let mut gradient = vec![[0.0; 2]; state.moves.len()];
        while state.steps < self.steps {
            let stop = meter.stop();
            if stop || meter.wants_checkpoint() {
                objective.prepared_for().clone_into(&mut state.prepared_for);
                keep(&state);
            }
            if stop {
                break;
            }
            let energy = objective.evaluate(&state.ahead, &mut gradient);
            state.steps += 1;
            meter.advance(Some(energy));
            state.step(self.rate, energy, &gradient, &masses);
        }
        state
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;
    use crate::watch::{Progress, Stage, Watch};

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

    fn run(descent: &Descent, watch: &dyn Watch) -> DescentState {
        let mut meter = Meter::new(watch, Stage::Optimizing, descent.steps);
        let start = DescentState::start(vec![[5.0, 5.0]; 2]);
        descent.run(&mut Valley([0.25, 0.75]), start, &mut meter, &mut |_| {})
    }

    #[test]
    fn reaches_the_bottom_of_a_narrow_valley() {
        let found = run(
            &Descent {
                steps: 600,
                rate: 0.9,
            },
            &(),
        );
        assert!(found.energy < 1e-6, "{}", found.energy);
        assert_eq!(found.steps, 600);
    }

    #[test]
    fn a_rate_that_is_too_large_is_lowered() {
        let found = run(
            &Descent {
                steps: 600,
                rate: 50.0,
            },
            &(),
        );
        assert!(found.energy < 0.02, "{}", found.energy);
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
        let descent = Descent {
            steps: 100,
            rate: 0.9,
        };
        let found = run(&descent, &Impatient(AtomicU32::new(0)));
        assert_eq!(found.steps, 7);
        let same = run(
            &Descent {
                steps: 7,
                ..descent
            },
            &(),
        );
        assert_eq!(found.moves, same.moves);
    }
}
