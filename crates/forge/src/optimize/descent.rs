//! Descent with momentum.

use super::{Meter, Objective};

/// How a descent runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Descent {
    /// How many evaluations it takes.
    pub steps: u32,
    /// Mean spacings moved per unit of gradient, at first; halved whenever a step without momentum
    /// raises the energy.
    pub rate: f64,
}

/// What a descent found.
#[derive(Clone, Debug, PartialEq)]
pub struct Descended {
    /// The moves with the lowest energy that was seen.
    pub moves: Vec<[f64; 2]>,
    /// That energy, per point.
    pub energy: f64,
    /// How many evaluations were made.
    pub steps: u32,
    /// Whether it was stopped before its last step.
    pub interrupted: bool,
}

impl Descended {
    /// A start, before any step.
    #[must_use]
    pub const fn at(moves: Vec<[f64; 2]>) -> Self {
        Self {
            moves,
            energy: f64::INFINITY,
            steps: 0,
            interrupted: false,
        }
    }
}

impl Descent {
    /// Lowers the energy from a start: Nesterov's momentum, which begins anew whenever it points
    /// uphill (O'Donoghue, Candès 2015). The momentum grows to what the energy's flat directions
    /// need, and nothing has to be tuned to them.
    pub fn run(
        &self,
        objective: &mut (impl Objective + ?Sized),
        start: Vec<[f64; 2]>,
        meter: &mut Meter<'_>,
    ) -> Descended {
        let masses = objective.masses().to_vec();
        let mut rate = self.rate;
        let mut at = start.clone();
        let mut ahead = start.clone();
        let mut gradient = vec![[0.0; 2]; start.len()];
        let mut best = Descended::at(start);
        let (mut age, mut last) = (0.0, f64::INFINITY);
        for step in 0..self.steps {
            if meter.stop() {
                best.interrupted = true;
                break;
            }
            let energy = objective.evaluate(&ahead, &mut gradient);
            best.steps = step + 1;
            meter.advance(Some(energy));
            if energy < best.energy {
                best.energy = energy;
                best.moves.clone_from(&ahead);
            }
            // Should it ever rise, begin anew from the best; if momentum was not to blame, the step
            // was too long.
            let rose = energy > last || energy.is_nan();
            last = energy;
            if rose {
                rate *= if age <= 1.0 { 0.5 } else { 1.0 };
                (age, last) = (0.0, f64::INFINITY);
                at.clone_from(&best.moves);
                ahead.clone_from(&best.moves);
                continue;
            }
            let mut uphill = 0.0;
            age += 1.0;
            let momentum = age / (age + 3.0);
            for (((at, ahead), slope), mass) in
                at.iter_mut().zip(&mut ahead).zip(&gradient).zip(&masses)
            {
                for axis in 0..2 {
                    let next = ahead[axis] - rate * slope[axis];
                    let by = next - at[axis];
                    uphill += mass * slope[axis] * by;
                    at[axis] = next;
                    ahead[axis] = next + momentum * by;
                }
            }
            if uphill > 0.0 {
                age = 0.0;
                ahead.clone_from(&at);
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;
    use crate::optimize::{Progress, Stage, Watch};

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

    fn run(descent: &Descent, watch: &dyn Watch) -> Descended {
        let mut meter = Meter::new(watch, Stage::Optimizing, descent.steps);
        descent.run(&mut Valley([0.25, 0.75]), vec![[5.0, 5.0]; 2], &mut meter)
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
    fn a_rate_that_is_too_large_is_mended() {
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
    fn stops_when_told_with_the_best_so_far() {
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
        assert!(found.interrupted);
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
