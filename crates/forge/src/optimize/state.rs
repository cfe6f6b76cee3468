//! The state of a descent between two steps.

/// Everything a descent knows between two steps: going on from it gives what going on would have
/// given, bit by bit.
#[derive(Clone, Debug, PartialEq)]
pub struct DescentState {
    /// The moves with the lowest energy that was seen.
    pub moves: Vec<[f64; 2]>,
    /// That energy, per point.
    pub energy: f64,
    /// How many evaluations were made.
    pub steps: u32,
    /// The last energy, unless the descent has begun anew since.
    pub(crate) last: f64,
    /// Steps since the momentum began.
    pub(crate) age: f64,
    /// The present rate as a part of the first.
    pub(crate) slowing: f64,
    /// Where the last step led.
    pub(crate) at: Vec<[f64; 2]>,
    /// The same, carried on by the momentum.
    pub(crate) ahead: Vec<[f64; 2]>,
    /// The moves for which the objective made its lists: see [`Objective::prepared_for`](super::Objective::prepared_for).
    pub(crate) prepared_for: Vec<[f64; 2]>,
}

impl DescentState {
    /// A start, before any step.
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
}

impl DescentState {
    /// Takes the step that an energy and its gradient at `ahead` call for.
    pub(super) fn step(
        &mut self,
        first_rate: f64,
        energy: f64,
        gradient: &[[f64; 2]],
        masses: &[f64],
    ) {
        if energy < self.energy {
            self.energy = energy;
            self.moves.clone_from(&self.ahead);
        }
        // Should it ever rise, begin anew from the best; if momentum was not to blame, the step
        // was too long.
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
        for (((at, ahead), slope), mass) in self
            .at
            .iter_mut()
            .zip(&mut self.ahead)
            .zip(gradient)
            .zip(masses)
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
            self.age = 0.0;
            self.ahead.clone_from(&self.at);
        }
    }
}
