//! The spacing at which an area holds a given number of points.

use alloc::sync::Arc;

use super::{Plan, PlanError, Sampler, Selection, Spacing};

/// Why no spacing gives a number of points.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CountError {
    /// The count is 0.
    #[error("the count is 0; it must be at least 1")]
    Zero,
    /// The area cannot be planned.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// Even the least spacing allowed gives fewer points.
    #[error("no spacing gives {0} points here")]
    NotFound(u128),
    /// The spacing would be less than the caller allows.
    #[error("{count} points take a spacing below {least} here")]
    TooDense {
        /// How many points are asked for.
        count: u128,
        /// The least spacing allowed.
        least: f64,
    },
}

/// More steps than a bisection of any bracket takes.
const MOST_STEPS: usize = 400;

impl Sampler {
    /// A plan of exactly `count` points of the selection, at the spacing that takes; the selection's
    /// own spacing does not matter.
    ///
    /// As the spacing shrinks, points enter an area mostly one at a time. Without warp those of one
    /// column and block have the same x, and two may enter a box at once: then the plan is a window
    /// that leaves out the last one. The same is found everywhere, in up to some fifty counts of the
    /// area.
    ///
    /// # Errors
    /// [`CountError`] if the count is 0, the area cannot be planned, or no spacing allowed gives so
    /// many.
    pub fn select_count(
        self: &Arc<Self>,
        selection: &Selection,
        count: u128,
    ) -> Result<Plan, CountError> {
        self.select_count_from(selection, count, 0.0)
    }

    /// The same without looking at spacings below `least`: where counting takes time in proportion
    /// to the lattice rows, that bounds it.
    ///
    /// # Errors
    /// As [`select_count`](Self::select_count), and [`CountError::TooDense`].
    pub fn select_count_from(
        self: &Arc<Self>,
        selection: &Selection,
        count: u128,
        least: f64,
    ) -> Result<Plan, CountError> {
        if count == 0 {
            return Err(CountError::Zero);
        }
        let bounds = selection.area.bounds().ok_or(PlanError::Unbounded)?;
        let [width, height] = [0, 1].map(|i| bounds.max()[i] - bounds.min()[i]);
        let share = selection.placement.keep.get();
        let wanted = count as f64;
        let mut guess = libm::sqrt(width) * libm::sqrt(height) * libm::sqrt(share / wanted);
        let mut more: Option<Plan> = None;
        // Spacings with too many points, and with too few.
        let (mut low, mut high) = (0.0, f64::INFINITY);
        for _ in 0..MOST_STEPS {
            guess = guess.max(least);
            let Ok(spacing) = Spacing::new(guess) else {
                break;
            };
            let mut trial = selection.clone();
            trial.placement.spacing = spacing;
            let plan = match self.select(trial) {
                Ok(plan) => plan,
                // So dense that points cannot be told apart.
                Err(PlanError::TooFar { .. }) if low == 0.0 && high.is_finite() => {
                    low = guess;
                    guess = between(low, high);
                    continue;
                }
                Err(error) => return Err(error.into()),
            };
            let found = plan.total();
            if found == count {
                return Ok(plan);
            }
            if found > count {
                low = guess;
                if more.as_ref().is_none_or(|more| found < more.total()) {
                    more = Some(plan);
                }
            } else if guess <= least {
                return Err(CountError::TooDense { count, least });
            } else {
                high = guess;
            }
            // Counts go as spacing⁻²: that leads near; from there the bracket is halved.
            let law = guess * libm::sqrt(found.max(1) as f64 / wanted);
            let next = if high.is_infinite() {
                law.max(low * 1.000_001)
            } else if low == 0.0 {
                if found == 0 {
                    high * 0.7
                } else {
                    law.min(high * 0.999_999)
                }
            } else if high - low > 1e-3 * high && low < law && law < high {
                law
            } else {
                between(low, high)
            };
            if next <= low || next >= high {
                break;
            }
            guess = next;
        }
        let more = more.ok_or(CountError::NotFound(count))?;
        Ok(more.window(0, Some(count)))
    }
}

fn between(low: f64, high: f64) -> f64 {
    low + (high - low) / 2.0
}
